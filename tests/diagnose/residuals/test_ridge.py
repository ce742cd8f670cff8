"""`Prior`: what is known of numbers together holds until one of them may be anything."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.ridge import Prior

KNOWN = Prior({7: 2.0, 3: 0.1, 5: 4.0, 8: 1.0}, (5, 7, 3), np.array([[1.0, 0.6, -0.3], [0.6, 1.0, 0.2], [-0.3, 0.2, 1.0]]))


def inverse(prior: Prior, columns: tuple[int, ...]) -> Array:
    """Covariance by way of the precision."""
    return np.asarray(np.linalg.inv(prior.precision(columns)))


def test_its_precision_is_the_inverse_of_its_covariance_in_any_order():
    covariance = KNOWN.covariance((3, 8, 7, 5))
    np.testing.assert_allclose(covariance, [[0.01, 0.0, 0.04, -0.12], [0.0, 1.0, 0.0, 0.0], [0.04, 0.0, 4.0, 4.8], [-0.12, 0.0, 4.8, 16.0]])
    np.testing.assert_allclose(inverse(KNOWN, (3, 8, 7, 5)), covariance)


def test_of_some_columns_it_says_what_it_does_whatever_the_others_are():
    np.testing.assert_allclose(inverse(KNOWN, (7, 5)), KNOWN.covariance((7, 3, 5))[np.ix_([0, 2], [0, 2])])


def test_what_departs_by_itself_besides_adds_its_variance():
    """The same covariance, and more variance of that column alone; a column that was fixed departs by that only."""
    found = KNOWN.plus({7: 30.0, 9: 1.0})
    np.testing.assert_allclose(found.covariance((5, 7, 3, 8)), KNOWN.covariance((5, 7, 3, 8)) + np.diag([0.0, 900.0, 0.0, 0.0]))
    np.testing.assert_allclose(found.covariance((7, 9)), np.diag([904.0, 1.0]))


def test_what_is_off_by_more_is_so_by_itself():
    """The same covariance, and more variance of that column alone."""
    found = KNOWN.off_by_more({7: 6.0, 5: 1.0})
    np.testing.assert_allclose(found.covariance((5, 7, 3)), KNOWN.covariance((5, 7, 3)) + np.diag([0.0, 32.0, 0.0]))


def test_columns_that_are_fixed_are_gone():
    found = KNOWN.without((7, 8))
    assert set(found.sd) == {3, 5}
    np.testing.assert_allclose(found.covariance((3, 5)), KNOWN.covariance((3, 5)))
