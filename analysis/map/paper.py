# What the paper reports, and which contenders play a part in its claims.
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

# Who stands for the paper's systems; a folder means all its variants. Whoever is not named here, such as code of our
# own and newcomers, plays no part in a claim.
SYSTEMS = {"KLU": ("csc_klu/refactor",),
           "CHOLMOD": ("csc_cholmod",),
           "WSMP": ("csc_mumps", "csc_cholmod/supernodal"),
           "SuperLU": ("eigen_sparse/superlu",),
           "optimised dense": ("eigen_dense", "armadillo_dense")}
OTHERS = ("csc_klu", "csc_umfpack", "eigen_sparse")  # sparse folders besides, that libraries stand behind
FULL_PIVOTING = "csc_klu/factor"
GUARDED = "csc_klu/guarded"


def members(results, system):
    """Names of the contenders that stand for one of SYSTEMS, in the registry's order."""
    return _named(results, SYSTEMS[system])


def dense(results, pairs=False):
    """The optimised dense ones; with `pairs` on all BLAS pairs that were timed, since the best dense version is the
    best one measured."""
    names = members(results, "optimised dense")
    return names + [one for name in names if pairs for one in results.alternatives(name).implementation.unique()
                    if one not in names]


def sparse(results):
    """The sparse solvers of libraries with optimised operations."""
    return _named(results, [*(name for system, names in SYSTEMS.items() if system != "optimised dense" for name in names),
                            *OTHERS])


def _named(results, wanted):
    return [name for name in results.implementations if name in wanted or name.split("/")[0] in wanted]


def starting(name):
    """Whether it is one of the starting implementations that others are compared with."""
    return name in STARTING.values()
