# Scaling of unknowns cannot matter: T and D T D, D of powers of two, have the same solution bit for bit.
import numpy
import pytest

from analysis.extremes import motions
from analysis.extremes.motions import Chain

STEP, PENALTY = 1.25e-3, 1e9


def tangent(chain, angle, step, penalty):
    """T of Eq. (5) at `angle`, dense: rods and couplers are thin, their M [[1/3, 1/6], [1/6, 1/3]] m."""
    count = 2 * (chain.loops + 1)
    mass, rows = numpy.zeros((count, count)), []
    rods, couplers = chain.masses
    for i, rod in enumerate(rods):
        own, row = slice(2 * i, 2 * i + 2), numpy.zeros(count)
        mass[own, own] += rod / 3 * numpy.eye(2)
        row[own] = 2 * chain.length * numpy.array([numpy.sin(angle), numpy.cos(angle)])  # Eq. (7)
        rows.append(row)
    for i, coupler in enumerate(couplers):
        for a in (i, i + 1):
            for b in (i, i + 1):
                mass[2 * a:2 * a + 2, 2 * b:2 * b + 2] += coupler / (3 if a == b else 6) * numpy.eye(2)
        row, span = numpy.zeros(count), chain.feet[i + 1] - chain.feet[i]
        row[2 * i], row[2 * i + 2] = -2 * span, 2 * span
        rows.append(row)
    jacobian = numpy.array(rows)
    return mass + step**2 / 4 * penalty * jacobian.T @ jacobian


def solve(matrix, right, pivots_of=None):
    """By L U in the row order that partial pivoting chooses on `pivots_of`; by L D L^T without."""
    order = numpy.arange(len(matrix)) if pivots_of is None else eliminated(pivots_of, pivoting=True)[0]
    _, factors = eliminated(matrix[order], pivoting=False)
    found = right[order].copy()
    for k in range(len(found)):
        found[k + 1:] -= factors[k + 1:, k] * found[k]
    for k in reversed(range(len(found))):
        found[k] /= factors[k, k]
        found[:k] -= factors[:k, k] * found[k]
    return found


def eliminated(matrix, pivoting):
    """(order of rows, L and U in one matrix)"""
    factors, order = matrix.copy(), numpy.arange(len(matrix))
    for k in range(len(matrix)):
        if pivoting:
            swap = [k, k + int(numpy.argmax(abs(factors[k:, k])))]
            factors[swap], order[swap] = factors[swap[::-1]], order[swap[::-1]]
        factors[k + 1:, k] /= factors[k, k]
        factors[k + 1:, k + 1:] -= numpy.outer(factors[k + 1:, k], factors[k, k + 1:])
    return order, factors


def uniform(matrix):
    """The matrix with its diagonal brought between 1 and 4 by powers of two: the same for T and D T D."""
    d = 2.0**-numpy.floor(numpy.log2(numpy.diag(matrix)) / 2)
    return d[:, None] * matrix * d


@pytest.mark.parametrize("ratio", [1.0, 1e3, 1e6, 1e9])
def test_scaling_of_unknowns_changes_no_bit_but_by_the_choice_of_pivots(ratio):
    random = numpy.random.default_rng(1)
    matrix = tangent(motions.unlike_masses(10, ratio), 1.0, STEP, PENALTY)
    right = random.standard_normal(len(matrix))
    d = 2.0**random.integers(-20, 21, len(matrix))
    scaled = d[:, None] * matrix * d
    for pivots in (None, uniform):
        plain, other = (solve(one, side, pivots and pivots(one)) for one, side in ((matrix, right), (scaled, d * right)))
        assert (plain == d * other).all()
        assert ratio > 1e3 or plain == pytest.approx(numpy.linalg.solve(matrix, right), rel=1e-5)
    assert (solve(matrix, right, matrix) != d * solve(scaled, d * right, scaled)).any()


def test_the_tangent_is_that_of_the_energy():
    chain = Chain(2, rods=(1.0, 2.0, 3.0), couplers=(4.0, 5.0))
    mass = tangent(chain, 0.4, 1.0, 0.0)
    turning = numpy.tile([numpy.cos(0.4), -numpy.sin(0.4)], 3)
    assert turning @ mass @ turning == pytest.approx(6 / 3 + 9)
    assert tangent(chain, 0.4, 2.0, 1e9) @ turning == pytest.approx(mass @ turning, abs=1e-5)
