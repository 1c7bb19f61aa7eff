# What `mbs list --json` says: who there is, in the order that tables and figures use.
import re
from dataclasses import dataclass
from functools import cached_property

from analysis.core.gather import gather

NULL = "null/null"  # the harness's control: a simulation that does nothing
TWIN = "+twin"  # a second instance of a contender in the same process: what is told apart where nothing differs
ANCHOR = "csc_klu/refactor"  # stands on no BLAS: in common to the processes of all pairs and builds


@dataclass(frozen=True)
class Registry:
    listed: dict  # as printed

    entries = property(lambda self: self.listed["implementations"])  # folders with their variants, the unavailable ones too
    # {name: what is said of it and of its folder} of those that are available: of all; of those that stand for themselves; of those that are
    # another variant with a setting that was tried, whose name is "tried_for".
    _available = cached_property(lambda self: {one["name"]: entry | one for entry in self.entries if entry["available"] for one in entry["variants"]})
    variants = cached_property(lambda self: {name: one for name, one in self._available.items() if not one.get("tried_for")})
    tried = cached_property(lambda self: {name: one for name, one in self._available.items() if one.get("tried_for")})
    # Names of variants: those that are there to be read, and timed only where they are named; that stand on no library; the others, in order.
    examples = cached_property(lambda self: frozenset(name for name, one in self.variants.items() if one.get("role") == "example"))
    own = cached_property(lambda self: frozenset(name for name, one in self.variants.items() if one.get("library") == "none") - self.examples)
    libraries = cached_property(lambda self: [name for name in self.variants if name not in self.own | self.examples])
    dense = cached_property(lambda self: frozenset(name for name, one in self.variants.items() if one.get("dense")))

    def gpl(self, name):
        """Whether a program with the library of this variant may be distributed under the GPL alone."""
        return re.search(r"(?<!L)GPL", self.variants[name]["licence"]) is not None

    # {name: why it cannot be used, or ""} of the BLAS and LAPACK pairs.
    pairs = property(lambda self: {pair["name"]: "" if pair["available"] else pair["reason"] for pair in self.listed.get("blas", [])})

    @property
    def versions(self):
        """"Eigen 3.4.0", "KLU 1.3.9", …: each library once, of entries that name one or several ("A + B", "A, B")."""
        found = []
        for entry in self.entries:
            if entry["available"] and entry["library"] != "none":
                names, versions = (re.split(r" \+ |, ", entry[key]) for key in ("library", "version"))
                found += ([version if version.startswith(name) else f"{name} {version}" for name, version in zip(names, versions)]
                          if len(names) == len(versions) else [f"{entry['library']} {entry['version']}"])
        return list(dict.fromkeys(found))

    @property
    def coverage(self):
        """{terms and settings: names of the variants that serve just these}, beyond the paper's step on its own scenes; the most first."""
        found = gather(((*one.get("terms", []), *one.get("settings", [])), name) for name, one in self.variants.items())
        return dict(sorted(found.items(), key=lambda one: -len(one[0])))

    def serves(self, name, *settings):
        """Whether a variant serves settings by name; everyone serves the paper's step."""
        return set(settings) <= {"penalty", "double", *self.variants[name].get("settings", [])}
