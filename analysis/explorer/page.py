# What the template of explore.html gets: the data as JSON, and questions with the answers of this set.
import json

from scipy import special

from analysis.accuracy.winners import NEAR
from analysis.core import timing
from analysis.core.gather import gather
from analysis.core.registry import ANCHOR
from analysis.core.style import Look
from analysis.core.view import Folder, others
from analysis.explorer import data
from study.core.setting import read_settings

MOST = 200  # processes of an interval


def context(folder):
    """`data`: of the set in `folder`, and of stored sets of other processors beside it; `examples`: (question, state in the address, answer)."""
    sets = {one: data.read(one) for one in (folder, *others(folder))}
    names = list(dict.fromkeys(name for found in sets.values() for name in data.names_of(found)))
    number = {name: place for place, name in enumerate(names)}
    registries = [Folder(one).registry for one in sets]
    about = [_about(name, registries) for name in names]
    contests = [one for part in ("families", "map") for one in sets[folder][part]]
    known = {"sets": [data.as_json(one, found, number) for one, found in sets.items()], "names": about, "sizes": data.size_of(contests),
             "settings": {one.name: one.typed for one in read_settings()},
             "equivalent": timing.EQUIVALENT, "anchor": ANCHOR, "near": NEAR,
             "quantiles": special.stdtrit(range(1, MOST), (1 + timing.CONFIDENCE) / 2).tolist()}
    text = json.dumps(known, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return {"data": text.replace("<", "\\u003c"), "examples": [*examples(contests, registries[0])]}


def _about(name, registries):
    """What can be asked of a name: whether it is own code, dense, under the GPL; its licence and colour."""
    plain = name.partition("+")[0]
    for registry in registries:
        if plain in registry.variants:
            return {"name": name, "own": plain in registry.own, "dense": plain in registry.dense, "gpl": registry.gpl(plain),
                    "licence": registry.variants[plain]["licence"], "colour": Look(registry).colour(plain)}
    return {"name": name, "own": False, "dense": False, "gpl": False, "licence": "", "colour": "#777777"}


ASKED = (  # of the examples: the least fill of the mechanism, %, and who is left out; words
    (0, 30, ("own",), "libraries only"),
    (30, 101, ("own", "gpl"), "a filled tangent, no GPL"),
    (0, 30, ("own", "penalty"), "libraries only, saddle-point form"))


def examples(contests, registry):
    """[{"case", "state", "take"}]: each on the largest mechanism of its kind, of another family."""
    used, kinds = set(), gather(((one.scene, one.form), one) for one in contests)
    known = [max(same, key=lambda one: len(one.rows)) for same in kinds.values()]  # that with most samples, as the page takes it
    for low, high, without, words in ASKED:
        names = [name for name in registry.variants if not ("own" in without and name in registry.own or "gpl" in without and registry.gpl(name))]
        ranked = [(one, ranking) for one in known if one.family not in used and low <= one.fill < high
                  and one.form == ("saddle-point" if "penalty" in without else "penalty") for ranking in [one.rank(names)] if ranking]
        if ranked:
            one, ranking = max(ranked, key=lambda pair: pair[0].n)
            used.add(one.family)
            others, doubt = ranking.equivalent[1:], "" if ranking.settled else " (not decided)"
            yield {"case": f"{one.scene}: {one.n:.0f} variables, {words}",
                   "take": f"{ranking.winner}{doubt}" + (f"; as fast: {', '.join(others)}" if others else ""),
                   "state": f"scene={one.scene}&no={','.join(without)}"}
