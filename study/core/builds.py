# The same program built by other compilers and flags, for comparing them within one run.
import subprocess

from analysis.core.files import ROOT
from study.core.executor import program_of

BUILDS = {  # name: (C++ compiler, C compiler, flags)
    f"{family}-{level}": (*compilers, f"-{level} -DNDEBUG")
    for family, compilers in (("gcc", ("g++", "gcc")), ("clang", ("clang++", "clang")))
    for level in ("O2", "O3")
    if (family, level) != ("gcc", "O3")}  # which is the study's own


def build(name, log, show):
    """Builds `mbs` of the build `name`; returns why that failed, or "". `show` is called with each line."""
    cxx, cc, flags = BUILDS[name]
    folder = (ROOT / program_of(build=name)).parent
    for command in (["cmake", "-S", str(ROOT), "-B", str(folder), "-G", "Ninja",
                     "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_COMPILER={cxx}",
                     f"-DCMAKE_C_COMPILER={cc}", f"-DCMAKE_CXX_FLAGS_RELEASE={flags}"],
                    ["cmake", "--build", str(folder), "--target", "mbs_program"]):
        try:
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                       text=True, errors="replace")
        except OSError as error:
            return f"cannot run {command[0]}: {error.strerror}"
        lines = []
        for line in process.stdout:
            log.write(line)
            lines = lines[-50:] + [line.strip()]
            show(f"{name}: {line.strip()}")
        if process.wait() != 0:
            error = next((line for line in lines if "error" in line.lower()), "see the log")
            return f"the build with {cxx} {flags} failed: {' '.join(error.split())[:300]}"
    return ""
