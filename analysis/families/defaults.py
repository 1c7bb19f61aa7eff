# Defaults of other tools as rules for our contenders, and what following them costs on mechanisms whose fastest library is known.
# A tool's solver is mapped to the contender that calls the same library; where none does, to the nearest, which the rule says.
from collections import Counter, namedtuple

import numpy
import pandas

DENSE, KLU, UMFPACK = "armadillo_dense/potrf", "csc_klu/refactor", "csc_umfpack/symmetric"
MODELICA, JULIA = "github.com/OpenModelica/OpenModelica", "github.com/SciML/LinearSolve.jl"
MUMPS, CHOLMOD, SUPERNODAL = "csc_mumps/spd", "csc_cholmod/simplicial", "csc_cholmod/supernodal"

Rule = namedtuple("Rule", "name source chooses choose")  # choose: (n, share of the tangent's n² positions that are filled) → contender
RULES = (
    Rule("OpenModelica, 2016", "github.com/OpenModelica/OMCompiler, pull request 529 (2016)",
         "UMFPACK if fill is at most 20 % and n at least 4001; else LAPACK", lambda n, fill: UMFPACK if fill <= 0.2 and n >= 4001 else DENSE),
    Rule("OpenModelica, linear systems", f"{MODELICA}, pull request 7695 (2021) and simulation_options.h, linearSystem.c of the C runtime since",
         "KLU if fill is below 20 % or n above 1000; else LAPACK", lambda n, fill: KLU if fill < 0.2 or n > 1000 else DENSE),
    Rule("OpenModelica, nonlinear systems", f"{MODELICA}, pull requests 7933, 8135, 8136 and 8167 (2021) and simulation_options.h since",
         "KLU if fill is below 10 % or n above 1000; else LAPACK", lambda n, fill: KLU if fill < 0.1 or n > 1000 else DENSE),
    Rule("LinearSolve.jl, 2022", f"{JULIA}, pull request 168 (2022)", "sparse matrices: KLU up to n = 10 000, then UMFPACK",
         lambda n, fill: KLU if n <= 10_000 else UMFPACK),
    Rule("LinearSolve.jl, 2023", f"{JULIA}, pull request 343 (2023) and src/default.jl then",
         "sparse matrices: KLU up to n = 10 000 if fill is below 0.02 %; else UMFPACK", lambda n, fill: KLU if n <= 1e4 and fill < 2e-4 else UMFPACK),
    Rule("LinearSolve.jl, 2026", f"{JULIA}, pull request 992 (2026) and ext/LinearSolveSparseArraysExt.jl since",
         "sparse matrices: KLU up to n = 1000, up to 10 000 if fill is below 0.02 %; else UMFPACK",
         lambda n, fill: KLU if n <= 1000 or n <= 10_000 and fill < 2e-4 else UMFPACK),
    Rule("Ipopt without HSL", "github.com/coin-or/Ipopt, src/Algorithm/IpAlgBuilder.cpp (3.14)",
         "MUMPS, where neither HSL's MA27 and its successors nor Pardiso, SPRAL or WSMP are linked; MA27, its first choice, has no stand-in here",
         lambda n, fill: MUMPS),
    Rule("MBDyn", "mbdyn.org, libraries/libmbwrap/linsol.cc, sources of 2017 and 2023",
         "UMFPACK where it is built with it (else KLU, else its own)", lambda n, fill: UMFPACK),
    Rule("Dense below 50", "as stated in González et al. (2008), section 5", "dense if n is below 50; else, our choice, KLU",
         lambda n, fill: DENSE if n < 50 else KLU),
    Rule("The map of 2008", "González et al. (2008), doi.org/10.1007/s00466-007-0218-2, Figures 6 and 7, borders read by eye",
         "above 900 variables CHOLMOD; else KLU up to 40 % fill, then WSMP, for which CHOLMOD's supernodal part stands",
         lambda n, fill: CHOLMOD if n > 900 else KLU if fill <= 0.4 else SUPERNODAL))


def table(data, records, rules=RULES):
    """A row a rule, from the losses of rule.py in the paper's form: time of what it chooses over that of the fastest library, on all
    mechanisms where that is known; on some by a first look alone, there or on a smaller machine. records: by form, scene and contender."""
    losses, known_by = (one.get("penalty", pandas.DataFrame()) for one in (data.losses, data.known_by))
    for rule in rules:
        chosen = {scene: rule.choose(data.features.n[scene], data.features.fill[scene] / 100) for scene in losses.index}
        by = {scene: known_by[name][scene] for scene, name in chosen.items() if name in losses and known_by[name][scene] not in ("", "failed")}
        ratios = {scene: 1 + losses[chosen[scene]][scene] for scene in by}
        where, counts = max(ratios, key=ratios.get, default=""), Counter(by.values())
        yield {
            "rule": rule.name, "source": rule.source, "chooses": rule.chooses, "scenes": len(losses), "timed": len(by),
            "rough": counts["look"] + counts["smaller"], "smaller": counts["smaller"], "worst": ratios.get(where), "where": where,
            "chosen": ", ".join(f"{name} on {count}" for name, count in Counter(chosen.values()).most_common()),
            "mean": float(numpy.exp(numpy.mean(numpy.log([*ratios.values()])))) if by else None,
            "record": records["penalty", where, chosen[where]] if by else ""}
