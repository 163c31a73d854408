"""onnx_test.py THERMFIT MODEL: the exported ONNX model is valid and onnxruntime computes what the model says."""

import json
import os
import subprocess
import sys
import tempfile

import numpy
import onnx
import onnxruntime

thermfit, model = sys.argv[1:]
document = json.load(open(model))
coefficients, intercept = numpy.array(document["um_per_K"]), numpy.array(document["intercept_um"])
rises = numpy.random.default_rng(1).normal(0, 10, (1000, len(coefficients)))

for scalar, allowed in [("double", 1e-13), ("float", 3e-5)]:
    for unit, per_um in [("um", 1), ("mm", 0.001), ("0.1um", 10)]:
        for sign, factor in [("error", 1), ("correction", -1)]:
            path = os.path.join(tempfile.mkdtemp(), "model.onnx")
            subprocess.run([thermfit, "export", model, "--target", "onnx", "--scalar", scalar, "--unit", unit, "--sign",
                            sign, "-o", path], check=True)
            onnx.checker.check_model(onnx.load(path), full_check=True)
            session = onnxruntime.InferenceSession(path)
            source = session.get_inputs()[0]
            assert source.name == "temperature_rise_K", source.name
            metadata = session.get_modelmeta().custom_metadata_map
            assert metadata["sign"] == sign and metadata["unit"].replace(" ", "") == unit, metadata
            dtype = numpy.float64 if scalar == "double" else numpy.float32
            (got,) = session.run(None, {source.name: rises.astype(dtype)})
            expected = factor * per_um * (rises @ coefficients + intercept)
            difference = numpy.abs(got - expected).max() / max(1, per_um)
            print(scalar, unit, sign, "largest difference %.1e" % difference, os.path.getsize(path), "bytes")
            assert difference <= allowed
for cut in range(1, os.path.getsize(path), 37):
    open(path + ".cut", "wb").write(open(path, "rb").read()[:cut])
    try:
        onnx.checker.check_model(onnx.load(path + ".cut"), full_check=True)
        raise SystemExit("accepted when cut at byte %d" % cut)
    except SystemExit:
        raise
    except Exception:
        pass
