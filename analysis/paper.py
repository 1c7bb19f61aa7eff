# What the paper reports, and which implementations stand for its systems in tables and claims.
TITLE = "González et al., Comput. Mech. 41 (2008) 607-615"

# Table 1: share of CPU time, %, by group of phases.
GROUPS = {"residual and tangent": ("evaluation", "assembly"),
          "right-hand side of (6)": ("projection",),
          "factorize and solve": ("factorization", "solve"),
          "other": ("other",)}
TABLE1 = {("dense", 22): (48, 4, 44, 4), ("sparse", 82): (15, 13, 51, 21)}
STARTING = {"dense": "starting_dense/gesv", "sparse": "starting_sparse/mumps"}

# Table 2: ms before and after symbolic preprocessing; neither size nor number of calls is stated.
TABLE2 = {"rank_k_update": (2528.2, 9.4, 269), "matrix_addition": (140.9, 1.9, 74),
          "jacobian_evaluation": (11.6, 3.8, 3)}
OPERATIONS = {"rank_k_update": "rank-k update", "matrix_addition": "matrix addition",
              "jacobian_evaluation": "Jacobian evaluation"}
NOT_OPTIMISED = "ublas_sparse"  # folder

# Implementations that stand for the paper's systems; a folder means all its variants.
SYSTEMS = {"KLU": ("csc_klu/refactor",),
           "CHOLMOD": ("csc_cholmod",),
           "WSMP": ("csc_mumps", "csc_cholmod/supernodal"),
           "SuperLU": ("eigen_superlu/superlu",),
           "optimised dense": ("eigen_dense", "armadillo_dense")}
FULL_PIVOTING = "csc_klu/factor"
GUARDED = "csc_klu/guarded"


def members(results, system):
    """Names of `results` that stand for one of SYSTEMS, in the registry's order."""
    wanted = SYSTEMS[system]
    return [name for name in results.implementations
            if name in wanted or name.split("/")[0] in wanted]


def dense(results):
    return [name for name in results.implementations if results.variants[name].get("dense")]


def sparse(results):
    return [name for name in results.implementations if not results.variants[name].get("dense")]


def starting(name):
    """Whether `name` is one of the starting implementations that others are compared with."""
    return name.startswith("starting_")


def optimised(results):
    """Sparse implementations of today: neither starting nor with operations left as they come."""
    return [name for name in sparse(results)
            if not starting(name) and name.split("/")[0] != NOT_OPTIMISED]


def library_backed(results):
    """Optimised sparse implementations that factorize with a library's sparse solver."""
    return [name for name in optimised(results)
            if results.variants[name].get("library", "") not in ("", "none")]
