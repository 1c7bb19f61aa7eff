# What runs of a validation are held against: the motion of a scene on which two schemes agree, and which half the step leaves as it is.
import math

import numpy
from scipy.interpolate import CubicHermiteSpline

from analysis.core.outcomes import FINISHED, of_run
from study.core.cell import Cell

MOVING = ("free", "marker", "vector")  # of describe: what an error is of; markers are points of bodies, no coordinates
POINTS = 40     # whose positions are compared, spread over the scene
GOLDEN = (5**0.5 - 1) / 2  # of the list, from one of them to the next: no kind of point that comes every so often is passed over
DENSE = 400     # instants of the reference, at least; between them cubics through positions and velocities
DENSER, DENSEST = 4, 25600  # times as many where cubics would be off; at most
INSTANTS = 150  # at which a run is compared, at least
FIRST_STEP, HALVINGS = 5e-4, 5  # s, of the reference at most; how often it is halved until all agree
SCHEMES = ("saddle-point", "penalty")


def spread(count):
    """Places of at most POINTS of so many points, in order."""
    return range(count) if count <= POINTS else sorted({count - 1, *(int(one * GOLDEN % 1 * count) for one in range(POINTS - 1))})


class Truth:
    """`uncertainty`, m: by how much the two schemes, or steps and half of them, differ at most, or cubics between the instants are off;
    infinite without a reference."""

    def __init__(self, lab, scene, described, contender, duration, enough):
        self.duration, self.uncertainty = duration, math.inf
        axes = "xyz"[:described["dimension"]]
        points = [one["name"] for one in described["elements"]["points"] if one["kind"] in MOVING]
        points = [points[place] for place in spread(len(points))]
        self.columns, self.speeds = (tuple(f"{point}.{v}{axis}" for point in points for axis in axes) for v in ("", "v"))
        self.shape = (len(points), len(axes))
        dense, halving, longer = DENSE, 0, None  # the motion of steps twice as long
        while halving < HALVINGS and dense <= DENSEST:
            every = math.ceil(duration / dense / FIRST_STEP) * 2**halving
            found = [self._extrapolated(lab, scene, contender, scheme, dense, every) for scheme in SCHEMES]
            if any(one is None for one in found):
                halving, longer = halving + 1, None
                continue
            t, q, v = found[0]
            self.motion = CubicHermiteSpline(t, q, v)
            # Those through every other instant are off at the others; at half the distance by an eighth of that or less.
            between = self._distance(CubicHermiteSpline(t[::2], q[::2], v[::2])(t[1:-1:2]), q[1:-1:2]) / 8
            self.uncertainty = max(between, math.inf if longer is None else self._distance(q, longer), self._distance(q, found[1][1]))
            if self.uncertainty <= enough:
                return
            if between > enough:
                dense, longer = dense * DENSER, None
            else:
                halving, longer = halving + 1, q

    def every(self, step, duration):
        """Steps between two instants of a run."""
        return max(1, int(duration / step / INSTANTS))

    def error(self, series):
        """The largest distance of a point at any instant, m."""
        return self._distance(self.motion(series["t"]), self._of(series, self.columns))

    def _extrapolated(self, lab, scene, contender, scheme, dense, every):
        """(t, q, v) by steps of duration/dense/every and half of that, to fourth order; None where a run was lost."""
        words = ("--duration", f"{self.duration:g}", "--scheme", scheme)
        found = lab.run([Cell("simulate", scene, (contender,), ("--step", f"{self.duration / dense / more:.12g}", *words), "reference", seconds=600,
                              keep=self.columns + self.speeds, every=more) for more in (every, 2 * every)])
        if any(of_run(one)[0] not in FINISHED for one in found):
            return None
        length = min(len(one.series["t"]) for one in found)
        coarse, fine = ({name: values[:length] for name, values in one.series.items()} for one in found)
        q, v = ((4 * self._of(fine, names) - self._of(coarse, names)) / 3 for names in (self.columns, self.speeds))
        return numpy.array(fine["t"]), q, v

    @staticmethod
    def _of(series, columns):
        return numpy.array([series[name] for name in columns], dtype=float).T

    def _distance(self, one, other):
        length = min(len(one), len(other))
        apart = (one[:length] - other[:length]).reshape(length, *self.shape)
        return float(numpy.sqrt((apart**2).sum(axis=2)).max())
