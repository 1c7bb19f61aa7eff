#!/bin/bash
# Starts a command of the study, `python.sh COMMAND …`, with Debian's own interpreter, whatever `python3` on PATH may be.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
there='import importlib.util as found, sys; sys.exit(None in map(found.find_spec, ("yaml", "numpy", "pandas", "scipy")))'
if ! /usr/bin/python3 -c "$there" 2> /dev/null; then  # what commands need before they look for themselves
  if [[ "$1" != run || " $* " == *" --dry-run "* || " $* " == *" --list "* ]]; then
    echo "study/$1: Debian's /usr/bin/python3 or one of its packages python3-yaml, -numpy, -pandas, -scipy is missing: run study/setup" >&2
    exit 1
  fi
  "$here/setup" --no-build
fi
unset PYTHONHOME VIRTUAL_ENV
export PYTHONPATH="$here/.." PYTHONNOUSERSITE=1 MPLBACKEND=Agg
exec /usr/bin/python3 -P -m study.main "$@"  # -P: not the study of the folder that it is typed in
