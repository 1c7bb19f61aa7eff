# What a step takes, from numbers of a scene: passes times a sum of products of features, with coefficients that are not negative.
#
# Terms are what a pass does: something for each variable, constraint entry, spring, non-zero of the matrix and of its factor, and
# the operations of the factorization. Passes are the same for all: when times are compared only counts decide. Coefficients are those of
# the least squares of log(predicted/measured), of relative errors made so by weights.
import numpy

PASSES = {"penalty": "passes", "saddle-point": "saddle_passes"}
OF_A_PASS = {  # by form and whether the implementation's matrices are dense
    ("penalty", False): "1 n jacobian springs tangent factor flops supernodes",
    ("penalty", True): "1 n jacobian springs n*n n*n*n",
    ("saddle-point", False): "1 n jacobian saddle_factor saddle_flops",
    ("saddle-point", True): "1 n jacobian n*n n*m m*m m*m*m n*n*m n*m*m stiff*n*m"}
TERMS = {(form, dense): tuple(f"{PASSES[form]}*{term}" for term in terms.split()) for (form, dense), terms in OF_A_PASS.items()}
# Springs take in the saddle-point form what they do in the penalty form, of which far more are measured: their forces; with dense ones T₀ too,
# which is factorized as T is there. What is solved with its factor costs n m more. That these terms are enough was chosen with a look at
# families left out.
AS_PENALTY = {f"{PASSES['saddle-point']}*{term}": f"{PASSES['penalty']}*{there}"
              for term, there in (("springs", "springs"), ("stiff*n*n", "n*n"), ("stiff*n*n*n", "n*n*n"))}
ROUNDS = 8  # of weights


def features_of(term):
    return [name for name in term.split("*") if name != "1"]


FEATURES = tuple(dict.fromkeys(name for terms in (*TERMS.values(), AS_PENALTY) for term in terms for name in features_of(term)))


def as_penalty(found, dense):
    """{term: µs} of the saddle-point form, from an implementation's model of the penalty form."""
    return {term: found[there] for term, there in AS_PENALTY.items() if there in found and (dense or "stiff" not in term)}


def model(terms, features, times, weights, known):
    """{term: µs} of scenes: their features, µs a step and weights. known: terms whose µs are given; the others are fitted beside them."""
    from scipy.optimize import nnls
    given = predicted(known, features) / times.to_numpy(float)
    matrix = _matrix(terms, features) / times.to_numpy(float)[:, None]
    scale = numpy.maximum(matrix.max(axis=0), numpy.finfo(float).tiny)
    matrix, relative = matrix / scale, numpy.ones(len(times))
    for _ in range(ROUNDS):  # w (p − 1)² with w = (log p / (p − 1))² is (log p)²
        root = numpy.sqrt(weights * relative)
        values, _ = nnls(matrix * root[:, None], root * (1 - given))
        ratio = numpy.maximum(matrix @ values + given, 1e-9)
        away = numpy.where(numpy.abs(ratio - 1) > 1e-6, ratio - 1, 1e-6)
        relative = (numpy.log1p(away) / away) ** 2
    return {term: float(value / size) for term, value, size in zip(terms, values, scale) if value > 0} | known


def predicted(found, features):
    """µs a step on scenes."""
    return _matrix(found, features) @ numpy.array(list(found.values()))


def _matrix(terms, features):
    ones = numpy.ones(len(features))
    return numpy.array([numpy.prod([ones, *(features[name].to_numpy() for name in features_of(term))], axis=0) for term in terms], float).T
