# A scene of the map: the N-four-bar at a size, with its own fill or an artificial one.
from dataclasses import dataclass

NATURAL = "natural"


@dataclass(frozen=True)
class Scene:
    variables: int
    fill: float | None  # share of the tangent's n^2 positions; None: the mechanism's own

    @property
    def name(self):
        return f"four-bar:{self.variables // 2 - 1}" + ("" if self.fill is None else f",fill={self.fill:.2f}")

    @property
    def steps(self):
        """About those of its stretch, which `mbs bench` chooses by the size."""
        return max(40, min(800, 800 * 400 // self.variables))
