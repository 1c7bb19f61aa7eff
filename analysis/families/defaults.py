# Defaults of other tools as rules for our contenders, and what following them costs on mechanisms whose fastest library is known.
# A tool's solver is mapped to the contender that calls the same library; where none does, to the nearest, which the rule says.
from collections import Counter, namedtuple

import numpy

DENSE, KLU, UMFPACK = "armadillo_dense/potrf", "csc_klu/refactor", "csc_umfpack/symmetric"
MUMPS, CHOLMOD, SUPERNODAL = "csc_mumps/spd", "csc_cholmod/simplicial", "csc_cholmod/supernodal"


Rule = namedtuple("Rule", "name source chooses choose")  # choose: (n, share of the tangent's n² positions that are filled) → contender
RULES = (
    Rule("OpenModelica, 2016", "OMCompiler, pull request 529 (2016)",
         "UMFPACK if fill is at most 20 % and n at least 4001; else LAPACK",
         lambda n, fill: UMFPACK if fill <= 0.2 and n >= 4001 else DENSE),
    Rule("OpenModelica, linear systems", "pull request 7695 (2021) and simulation_options.h, linearSystem.c of the C runtime since",
         "KLU if fill is below 20 % or n above 1000; else LAPACK", lambda n, fill: KLU if fill < 0.2 or n > 1000 else DENSE),
    Rule("OpenModelica, nonlinear systems", "pull requests 7933, 8135, 8136 and 8167 (2021) and simulation_options.h since",
         "KLU if fill is below 10 % or n above 1000; else LAPACK", lambda n, fill: KLU if fill < 0.1 or n > 1000 else DENSE),
    Rule("LinearSolve.jl, 2022", "pull request 168 (2022)", "sparse matrices: KLU up to n = 10 000, then UMFPACK",
         lambda n, fill: KLU if n <= 10_000 else UMFPACK),
    Rule("LinearSolve.jl, 2023", "pull request 343 (2023) and src/default.jl then",
         "sparse matrices: KLU up to n = 10 000 if fill is below 0.02 %; else UMFPACK",
         lambda n, fill: KLU if n <= 10_000 and fill < 2e-4 else UMFPACK),
    Rule("LinearSolve.jl, 2026", "pull request 992 (2026) and ext/LinearSolveSparseArraysExt.jl since",
         "sparse matrices: KLU up to n = 1000, up to 10 000 if fill is below 0.02 %; else UMFPACK",
         lambda n, fill: KLU if n <= 1000 or n <= 10_000 and fill < 2e-4 else UMFPACK),
    Rule("Ipopt without HSL", "src/Algorithm/IpAlgBuilder.cpp (3.14)",
         "MUMPS, where neither HSL's MA27 and its successors nor Pardiso, SPRAL or WSMP are linked; MA27, its first choice, has no stand-in here",
         lambda n, fill: MUMPS),
    Rule("MBDyn", "libraries/libmbwrap/linsol.cc, sources of 2017 and 2023", "UMFPACK where it is built with it (else KLU, else its own)", lambda n, fill: UMFPACK),
    Rule("Dense below 50", "as stated in González et al. (2008), section 5", "dense if n is below 50; else, our choice, KLU",
         lambda n, fill: DENSE if n < 50 else KLU),
    Rule("The map of 2008", "González et al. (2008), Figures 6 and 7, borders read by eye",
         "above 900 variables CHOLMOD; else KLU up to 40 % fill, then WSMP, for which CHOLMOD's supernodal part stands",
         lambda n, fill: CHOLMOD if n > 900 else KLU if fill <= 0.4 else SUPERNODAL))


def table(scenes, winners, rules=RULES):
    """A row a rule, from the rows of scenes and winners: time of what it chooses over that of the fastest library, on all
    mechanisms that have both. Who was only looked at has a rough time, and the row says on how many."""
    rows = {(row["scene"], row["implementation"]): row for row in scenes}
    known = [row for row in winners if row["layer"] == "libraries" and row.get("winner")]
    for rule in rules:
        chosen, losses, rough, records = Counter(), {}, 0, {}
        for winner in known:
            scene = winner["scene"]
            about = rows[scene, winner["winner"]]
            name = rule.choose(about["variables"], about["fill"] / 100)
            row = rows.get((scene, name), {})
            chosen[name] += 1
            if row.get("status") == "ok" and row.get("to_rival", 0) > 0:
                losses[scene] = row["to_rival"]
            elif row.get("status") == "slower" and (row.get("look_us") or 0) > 0:  # who did not finish the look has none
                losses[scene] = row["look_us"] / about["look_us"]
                rough += 1
            records[scene] = row.get("record", "")
        where = max(losses, key=losses.get, default="")
        yield {
            "rule": rule.name, "source": rule.source, "chooses": rule.chooses, "scenes": len(known), "timed": len(losses), "rough": rough,
            "chosen": ", ".join(f"{name} on {count}" for name, count in chosen.most_common()), "worst": losses.get(where), "where": where,
            "mean": float(numpy.exp(numpy.mean(numpy.log(list(losses.values()))))) if losses else None, "record": records.get(where, "")}
