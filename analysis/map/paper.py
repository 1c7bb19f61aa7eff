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
TABLE2 = {"rank_k_update": (2528.2, 9.4, 269), "matrix_addition": (140.9, 1.9, 74), "jacobian_evaluation": (11.6, 3.8, 3)}
OPERATIONS = {"rank_k_update": "rank-k update", "matrix_addition": "matrix addition", "jacobian_evaluation": "Jacobian evaluation"}
NOT_OPTIMISED = "ublas_sparse"  # folder

# Who stands for the paper's systems. Whoever is not named here plays no part in a claim: code of our own, newcomers,
# further variants of the same folders.
SYSTEMS = {"KLU": ("csc_klu/refactor",),
           "CHOLMOD": ("csc_cholmod/simplicial", "csc_cholmod/supernodal"),
           "WSMP": ("csc_mumps/spd", "csc_cholmod/supernodal"),
           "SuperLU": ("eigen_sparse/superlu",),
           "optimised dense": ("eigen_dense/llt", "armadillo_dense/potrf")}
OTHERS = ("csc_klu", "csc_ldl", "csc_umfpack", "eigen_sparse")  # sparse folders of libraries besides, in figures alone
FULL_PIVOTING = "csc_klu/factor"
SUBJECTS = {"T1": "time by phase", "T2": "symbolic preprocessing", "F2": "dense versions", "F4": "sparse solvers",
            "F5": "sparse against dense over fill", "F6": "regions, 10 to 100 variables", "F7": "regions, larger sizes",
            "C1": "pivoting of KLU", "C2": "best against starting sparse version", "C3": "BLAS under sparse solvers",
            "C4": "sparse against dense at small sizes", "C5": "compiler and operating system"}


def members(results, system):
    """Names of the contenders that stand for one of SYSTEMS, in the registry's order."""
    return _named(results, SYSTEMS[system])


def shared(results, system):
    """Those of them that stand for another system too: such a one cannot tell the two apart."""
    others = {name for other in SYSTEMS if other != system for name in members(results, other)}
    return [name for name in members(results, system) if name in others]


def dense(results):
    """The optimised dense ones on all BLAS pairs that were timed: the best dense version is the best one measured."""
    names = members(results, "optimised dense")
    return names + [one for name in names for one in results.alternatives(name).implementation.unique() if one not in names]


def sparse(results, others=False):
    """Sparse solvers that stand for one of the paper's; with `others` those of all libraries with optimised operations."""
    names = [name for system, found in SYSTEMS.items() if system != "optimised dense" for name in found]
    return _named(results, [*names, *OTHERS] if others else names)


def _named(results, wanted):
    return [name for name in results.implementations if name in wanted or name.split("/")[0] in wanted]
