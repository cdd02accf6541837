#!/usr/bin/python3
"""The numbers of a stroke against paths whose numbers are known."""
import os
import sys
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "scripts"))
import stroke_metrics as metrics  # noqa: E402


def minimum_jerk(duration, length, rate=1000):
    t = numpy.arange(0, duration + 0.5 / rate, 1 / rate)
    s = t / duration
    return t, numpy.outer(length * (10 * s**3 - 15 * s**4 + 6 * s**5), [1, 0, 0])


class StrokeMetricsTest(unittest.TestCase):
    def test_minimum_jerk(self):
        # Exactly: the integral of jerk^2 is 720 L^2 / T^5, the peak speed 15/8 L/T: ln(720 * (8/15)^2).
        expected = -numpy.log(720 * (8 / 15)**2)
        for duration, length in ((1, 0.1), (4, 0.02)):
            times, path = metrics.resample(*minimum_jerk(duration, length))
            self.assertAlmostEqual(metrics.log_dimensionless_jerk(times, path), expected, delta=0.15)
            self.assertAlmostEqual(metrics.spectral_arc_length(times, path), -1.41, delta=0.05)
            self.assertAlmostEqual(metrics.path_length(path), length, delta=1e-4 * length)
            self.assertAlmostEqual(metrics.speed(times, path).max(), 15 / 8 * length / duration,
                                   delta=0.01 * length / duration)

    def test_a_tremor_is_less_smooth(self):
        times, path = minimum_jerk(2, 0.1)
        shaky = path + numpy.outer(0.001 * numpy.sin(2 * numpy.pi * 6 * times), [1, 0, 0])
        calm, rough = metrics.resample(times, path), metrics.resample(times, shaky)
        self.assertLess(metrics.log_dimensionless_jerk(*rough), metrics.log_dimensionless_jerk(*calm) - 1)
        self.assertLess(metrics.spectral_arc_length(*rough), metrics.spectral_arc_length(*calm) - 0.1)

    def test_resting_and_short_strokes(self):
        still = numpy.zeros((50, 3))
        times = numpy.linspace(0, 1, 50)
        self.assertTrue(numpy.isnan(metrics.log_dimensionless_jerk(times, still)))
        self.assertTrue(numpy.isnan(metrics.spectral_arc_length(times, still)))
        self.assertEqual(metrics.path_length([[0, 0, 0]]), 0)
        metrics.resample([0, 0.001], [[0, 0, 0], [1, 0, 0]])

    def test_distance_to_polyline(self):
        line = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
        points = [[0.5, 0.2, 0], [2, 0.5, 0], [0.5, 0, -0.3], [-1, 0, 0]]
        numpy.testing.assert_allclose(metrics.distance_to_polyline(points, line), [0.2, 1, 0.3, 1])
        numpy.testing.assert_allclose(metrics.distance_to_polyline(points, line, [0, 0, 2]), [0.2, 1, 0, 1])

    def test_entries(self):
        points = [[0, 0, 0]] * 3 + [[5, 5, 5]] + [[0, 0, 0]] * 2
        self.assertEqual(metrics.entries([1, 2, 3, 8, 20, 21], points, [-1] * 3, [1] * 3), (2, 5))
        self.assertEqual(metrics.entries([1], [[9, 9, 9]], [-1] * 3, [1] * 3), (0, 0))


if __name__ == "__main__":
    unittest.main()
