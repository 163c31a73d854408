#!/bin/sh
# Makes build/python-venv with the packages of tests/python_packages.txt, which the `extern` tests use as references.
set -eu
cd "$(dirname "$0")/.."
venv=build/python-venv
list=tests/python_packages.txt
if [ -f $venv/done ] && cmp -s $list $venv/done; then exit 0; fi
echo "thermfit: installing Python packages into $venv: $(tr '\n' ' ' <$list)"
python3 -m venv $venv
$venv/bin/pip install --quiet --disable-pip-version-check -r $list
cp $list $venv/done
