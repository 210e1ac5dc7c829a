"""How the error of a prior falls with what it was given."""

from cranio_nb.prior.study import measure_learning_curve


def test_the_error_falls_with_the_number_of_skulls(learned):
    curve = measure_learning_curve(learned, sizes=(1,))
    assert [row.n_skulls for row in curve] == [1, len(learned.radii) - 1]
    assert curve[1].outer < curve[0].outer and curve[1].inner < curve[0].inner
