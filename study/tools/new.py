# study/new NAME: writes implementations/NAME/, which compiles and does nothing yet, and its line in the list.
import re
import shutil

from analysis.core.files import ROOT, StudyError, write_text
from study.core.options import Parser

SKELETON = ROOT / "study" / "tools" / "skeleton"
LIST = ROOT / "implementations" / "CMakeLists.txt"
NAME = re.compile(r"[a-z][a-z0-9_]*")
KEYWORDS = set("""alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t char32_t class compl concept const
consteval constexpr constinit const_cast continue co_await co_return co_yield decltype default delete do double dynamic_cast else enum explicit
export extern false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected
public register reinterpret_cast requires return short signed sizeof static static_assert static_cast struct switch template this thread_local
throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq""".split())
TAKEN = {"mbs", "std", "null", "reference", "limit", "control", "controls", "main", "all", "clean", "help", "install", "test", "harness", "engines",
         "registry", "implementation", "simulation", "available", "unavailable"}  # names of the harness, of C++ and of CMake
EIGEN = 'std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION)'
COLUMNS = "\n  // The lower half of T by rows is its upper half by columns, the default of {}."
IN_PLACE = "\n  // Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>, Eigen::Upper> works in place and allocates nothing."
ILAVER = '\nextern "C" void ilaver_(int* major, int* minor, int* patch);\n'
LAPACK = """std::string lapack_version() {
  int major = 0, minor = 0, patch = 0;
  ilaver_(&major, &minor, &patch);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

"""
# (name, licence, version as C++, include, how it takes what is stored, what the version needs outside of and inside namespaces)
LIBRARIES = {"none": ("none", "", '""', "", "", "", ""),
             "eigen": ("Eigen", "MPL-2.0", EIGEN, "#include <Eigen/Cholesky>\n", COLUMNS.format("Eigen") + IN_PLACE, "", ""),
             "blas": ("LAPACK", "BSD-3-Clause", "lapack_version()", "", COLUMNS.format("LAPACK"), ILAVER, LAPACK)}


def new(arguments):
    parser = Parser(prog="study/new", description="Writes the folder of a new implementation: it compiles, is in the list, and has empty "
                    "functions to fill in: predict, constraints, Jacobian, residual, tangent, factorize, solve, correct, project, the step.")
    parser.add_argument("name", metavar="NAME", help="its folder: lower case, digits, _")
    parser.add_argument("--library", default="none", choices=list(LIBRARIES), help="what it links (none)")
    options = parser.parse_args(arguments)
    folder = ROOT / "implementations" / options.name
    if not NAME.fullmatch(options.name):
        raise StudyError(f"'{options.name}' is no name: a letter from a to z, then such letters, digits or _")
    if options.name in KEYWORDS | TAKEN or re.match("(mbs|implementation)_", options.name) or "__" in options.name:
        raise StudyError(f"'{options.name}' is a name of C++ or of the harness: take another name")
    if folder.exists() or options.name in listed():
        raise StudyError(f"implementations/{options.name} exists already: take another name")
    try:
        values = dict(zip(("@NAME@", "@LIBRARY@", "@LICENCE@", "@VERSION@", "@INCLUDE@", "@STORAGE@", "@ILAVER@", "@LAPACK@"),
                          (options.name, *LIBRARIES[options.library])))
        for path in sorted(SKELETON.iterdir()):
            stem, _, only = path.name.partition("@")
            if only in ("", options.library):
                write_text(folder / stem, re.sub("@[A-Z]+@", lambda one: values[one[0]], path.read_text(encoding="utf-8")))
        before, after = LIST.read_text(encoding="utf-8").rsplit(")", 1)
        write_text(LIST, f"{before.rstrip()}\n  {options.name}\n){after}")
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise
    commands = {"cmake --build build --target mbs": "after each function",
                f"build/mbs check --ladder --implementation {options.name}": "the first quantity that is wrong, and how it usually gets so",
                f"study/add {options.name}": "once the ladder ends: beside the leaders"}
    print(f"implementations/{options.name}/ is written and in the list. Next:")
    for command, what in commands.items():
        print(f"  {command:{max(map(len, commands)) + 2}}# {what}")
    print("""The equations are in paper/README.md; implementations/minimal_dense is an example to read. Fill in simulation.cpp from top to
bottom, and climb the ladder after each function. CONTRIBUTING.md has what comes before and between: set-up, the gate, tests.""")
    return 0


def listed():
    return LIST.read_text(encoding="utf-8").split("mbs_registry(")[1].split(")")[0].split()
