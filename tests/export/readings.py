"""Readings of the example model's three sensors, with what can go wrong with them; and what `thermfit run` answers."""

import math
import random
import subprocess

SENSORS = ["T1", "T2", "T3"]


def readings(rows, seed=1, faults=True):
    """Rows of three readings in degC: a warm-up with noise of 0.01 K; now and then a sensor fails for a while."""
    source = random.Random(seed)
    failing = [(None, 0)] * 3
    result = []
    for n in range(rows):
        row = []
        for i in range(3):
            truth = round(20 + (6 - 2 * i) * (1 - math.exp(-n / 300)) + source.uniform(-0.05, 0.05), 2)
            kind, left = failing[i]
            if left:
                failing[i] = (kind, left - 1)
            elif faults and source.random() < 0.02:
                kind = source.choice(["missing", "jump", "range", "stuck"])
                failing[i] = (kind, source.choice([1, 2, 8, 60]))
                kind = None
            else:
                kind = None
            row.append({"missing": math.nan, "jump": truth + 7, "range": 500.0, None: truth}.get(
                kind, result[-1][i] if result else truth))
        result.append(row)
    return result


def as_csv(rows):
    return "\n".join([",".join(SENSORS)] + [",".join("NA" if math.isnan(x) else repr(x) for x in row) for row in rows]) + "\n"


def run(thermfit, model, rows, *options):
    """Answers of `thermfit run`: (offsets in um, status word) a row."""
    answer = subprocess.run([thermfit, "run", model, *options], input=as_csv(rows), capture_output=True, text=True,
                            check=True).stdout.splitlines()
    names = answer[0].split(",")
    offsets = [i for i, name in enumerate(names) if name.startswith("offset_")]
    status = names.index("status")
    cells = [line.split(",") for line in answer[1:]]
    return [([float(row[i]) for i in offsets], int(row[status])) for row in cells]
