# Scaling of unknowns cannot matter: T and D T D, D of powers of two, have the same solution bit for bit.
#
# Multiplying by a power of two rounds nothing. So each number that Cholesky, L D L^T or LU computes from D T D is
# the one from T times a power of two, as long as both choose the same pivots; LU chooses them on the matrix scaled
# to a diagonal between 1 and 4 here, which is the same one for T and D T D.
import numpy

from study.extremes_study import scenes

LOOPS, STEP, PENALTY = 10, 1.25e-3, 1e9
RATIOS = (1.0, 1e3, 1e6, 1e9)
SEED = 1


def tangent(chain, angle, step, penalty):
    """T of Eq. (5) at `angle`, dense: rods and couplers are thin, their M [[1/3, 1/6], [1/6, 1/3]] m."""
    count = 2 * (chain.loops + 1)
    mass, rows = numpy.zeros((count, count)), []
    rods, couplers = chain.masses
    for i, rod in enumerate(rods):
        own = slice(2 * i, 2 * i + 2)
        mass[own, own] += rod / 3 * numpy.eye(2)
        row = numpy.zeros(count)
        row[own] = 2 * chain.length * numpy.array([numpy.sin(angle), numpy.cos(angle)])  # Eq. (7)
        rows.append(row)
    for i, coupler in enumerate(couplers):
        for a in (i, i + 1):
            for b in (i, i + 1):
                mass[2 * a:2 * a + 2, 2 * b:2 * b + 2] += coupler / (3 if a == b else 6) * numpy.eye(2)
        row = numpy.zeros(count)
        span = chain.feet[i + 1] - chain.feet[i]
        row[2 * i], row[2 * i + 2] = -2 * span, 2 * span
        rows.append(row)
    jacobian = numpy.array(rows)
    return mass + step**2 / 4 * penalty * jacobian.T @ jacobian


def cholesky(matrix, right):
    factor = numpy.tril(matrix)
    for k in range(len(matrix)):
        factor[k, k] = numpy.sqrt(factor[k, k])
        factor[k + 1:, k] /= factor[k, k]
        for j in range(k + 1, len(matrix)):
            factor[j:, j] -= factor[j:, k] * factor[j, k]
    return _back(factor.T, _forward(factor, right))


def l_d_l(matrix, right):
    lower, diagonal = numpy.tril(matrix), numpy.zeros(len(matrix))
    for k in range(len(matrix)):
        diagonal[k], column = lower[k, k], lower[k + 1:, k].copy()
        lower[k, k] = 1.0
        lower[k + 1:, k] /= diagonal[k]
        for j in range(k + 1, len(matrix)):
            lower[j:, j] -= lower[j:, k] * column[j - k - 1]
    return _back(lower.T, _forward(lower, right) / diagonal)


def lu(matrix, right, chosen_on):
    """With the row order that partial pivoting chooses on `chosen_on`."""
    order, _ = _eliminate(chosen_on, pivoting=True)
    _, factors = _eliminate(matrix[order], pivoting=False)
    lower = numpy.tril(factors, -1) + numpy.eye(len(matrix))
    return _back(numpy.triu(factors), _forward(lower, right[order]))


def _eliminate(matrix, pivoting):
    factors, order = matrix.copy(), numpy.arange(len(matrix))
    for k in range(len(matrix)):
        if pivoting:
            swap = [k, k + int(numpy.argmax(abs(factors[k:, k])))]
            factors[swap], order[swap] = factors[swap[::-1]], order[swap[::-1]]
        factors[k + 1:, k] /= factors[k, k]
        factors[k + 1:, k + 1:] -= numpy.outer(factors[k + 1:, k], factors[k, k + 1:])
    return order, factors


def _forward(lower, right):
    found = right.copy()
    for k in range(len(found)):
        found[k] /= lower[k, k]
        found[k + 1:] -= lower[k + 1:, k] * found[k]
    return found


def _back(upper, right):
    found = right.copy()
    for k in reversed(range(len(found))):
        found[k] /= upper[k, k]
        found[:k] -= upper[:k, k] * found[k]
    return found


def uniform(matrix):
    """Powers of two that bring the diagonal between 1 and 4."""
    return 2.0**-numpy.floor(numpy.log2(numpy.diag(matrix)) / 2)


def rows():
    """One a mass ratio, solver and kind of scaling: how many components of x differ."""
    found, random = [], numpy.random.default_rng(SEED)
    for ratio in RATIOS:
        matrix = tangent(scenes.unlike_masses(LOOPS, ratio), 1.0, STEP, PENALTY)
        right = random.standard_normal(len(matrix))
        scalings = {"to a uniform diagonal": uniform(matrix),
                    "strewn over 2^-20 to 2^20": 2.0**random.integers(-20, 21, len(matrix))}
        for solver, solve in (("Cholesky", cholesky), ("L D Lᵀ", l_d_l),
                              ("LU, pivots of the scaled matrix", None), ("LU, pivots of its own", None)):
            for kind, d in scalings.items():
                scaled = d[:, None] * matrix * d
                if solve is None:
                    u, v = uniform(matrix), uniform(scaled)
                    own = solver.endswith("own")
                    plain = lu(matrix, right, matrix if own else u[:, None] * matrix * u)
                    other = d * lu(scaled, d * right, scaled if own else v[:, None] * scaled * v)
                else:
                    plain, other = solve(matrix, right), d * solve(scaled, d * right)
                found.append({"mass_ratio": ratio, "solver": solver, "scaling": kind,
                              "variables": len(matrix), "components_that_differ": int((plain != other).sum()),
                              "largest_difference": float(abs(plain - other).max() / abs(plain).max())})
    return found
