#!/bin/bash
# Starts a command of the study, `python.sh COMMAND …`, with Debian's own interpreter, whatever `python3` on PATH may be.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
unset PYTHONHOME VIRTUAL_ENV
export PYTHONPATH="$here/.." PYTHONNOUSERSITE=1 MPLBACKEND=Agg
python=(/usr/bin/python3 -P)  # -P: not the study of the folder that it is typed in
look='import importlib.util
print(*(name for name in "yaml numpy pandas scipy matplotlib jinja2 snakemake".split() if not importlib.util.find_spec(name)))'
missing=$("${python[@]}" -c "$look" 2> /dev/null) || missing='Python 3.11'
if [[ $missing ]]; then
  if [[ "$1" != run || " $* " == *" --dry"* || " $* " == *" --l"* || " $* " == *" --h"* || " $* " == *" -h "* ]]; then
    echo "study/$1: missing for /usr/bin/python3: $missing (run study/setup)" >&2
    exit 2
  fi
  "$here/setup" --no-build
fi
exec "${python[@]}" -m study.main "$@"
