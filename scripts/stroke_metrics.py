"""Numbers of a stroke from the path of a tool: plain numpy, no ROS.

Smoothness after Balasubramanian, Melendez-Calderon, Roby-Brami, Burdet: On the analysis of movement smoothness,
J. NeuroEngineering Rehabil. 12:112, 2015: log dimensionless jerk (equation 3) and spectral arc length (equation 5).
Higher (nearer to 0) is smoother in both.
"""
import numpy

RATE = 200.0  # Hz, of the resampled path
SMOOTHING = 0.02  # s, sigma of the Gaussian that takes a driver's noise out before it is differentiated thrice
CUTOFF = 10.0  # Hz, highest frequency of the spectral arc length
THRESHOLD = 0.05  # of the greatest amplitude: below it the spectrum is noise


def resample(times, points):
    """The path at RATE, smoothed. `times` s, rising; `points` n x 3, m. Returns times, points."""
    times, points = numpy.asarray(times, float), numpy.asarray(points, float)
    count = max(2, int(round((times[-1] - times[0]) * RATE)) + 1)
    even = numpy.linspace(times[0], times[-1], count)
    path = numpy.column_stack([numpy.interp(even, times, points[:, axis]) for axis in range(3)])
    sigma = SMOOTHING * RATE
    reach = int(3 * sigma)
    if count <= 2 * reach:
        return even, path
    kernel = numpy.exp(-0.5 * (numpy.arange(-reach, reach + 1) / sigma)**2)
    kernel /= kernel.sum()
    # Mirrored through the ends, so that they stay where they are.
    before = 2 * path[0] - path[reach:0:-1]
    after = 2 * path[-1] - path[-2:-reach - 2:-1]
    long = numpy.vstack([before, path, after])
    return even, numpy.column_stack([numpy.convolve(long[:, axis], kernel, "valid") for axis in range(3)])


def path_length(points):
    """m."""
    points = numpy.asarray(points, float)
    return float(numpy.linalg.norm(numpy.diff(points, axis=0), axis=1).sum()) if len(points) > 1 else 0.0


def speed(times, points):
    """m/s at each time."""
    return numpy.linalg.norm(numpy.gradient(points, times, axis=0), axis=1)


def log_dimensionless_jerk(times, points):
    """-ln(T^3 / v_peak^2 * integral of |jerk|^2 dt); nan for a stroke that does not move."""
    if len(times) < 5:
        return float("nan")
    velocity = numpy.gradient(points, times, axis=0)
    jerk = numpy.gradient(numpy.gradient(velocity, times, axis=0), times, axis=0)
    peak = numpy.linalg.norm(velocity, axis=1).max()
    duration = times[-1] - times[0]
    integral = numpy.trapz((jerk**2).sum(axis=1), times)
    if peak <= 0 or integral <= 0:
        return float("nan")
    return float(-numpy.log(duration**3 / peak**2 * integral))


def spectral_arc_length(times, points):
    """SPARC of the speed; nan for a stroke that does not move."""
    v = speed(times, points)
    if len(v) < 5 or v.max() <= 0:
        return float("nan")
    count = 2**(int(numpy.ceil(numpy.log2(len(v)))) + 4)
    frequency = numpy.fft.rfftfreq(count, times[1] - times[0])
    amplitude = numpy.abs(numpy.fft.rfft(v, count))
    amplitude /= amplitude.max()
    below = frequency <= CUTOFF
    frequency, amplitude = frequency[below], amplitude[below]
    last = numpy.nonzero(amplitude >= THRESHOLD)[0][-1]
    frequency, amplitude = frequency[:last + 1], amplitude[:last + 1]
    if len(frequency) < 2:
        return float("nan")
    return float(-numpy.hypot(numpy.diff(frequency / frequency[-1]), numpy.diff(amplitude)).sum())


def distance_to_polyline(points, polyline, direction=None):
    """Distance of each point from a polyline, m; with `direction`, seen along it: depth does not count."""
    points, polyline = numpy.asarray(points, float), numpy.asarray(polyline, float)
    if direction is not None:
        along = numpy.asarray(direction, float)
        along = along / numpy.linalg.norm(along)
        points = points - numpy.outer(points @ along, along)
        polyline = polyline - numpy.outer(polyline @ along, along)
    best = numpy.full(len(points), numpy.inf)
    for a, b in zip(polyline[:-1], polyline[1:]):
        edge = b - a
        square = edge @ edge
        share = numpy.clip((points - a) @ edge / square, 0, 1) if square > 0 else numpy.zeros(len(points))
        best = numpy.minimum(best, numpy.linalg.norm(points - a - numpy.outer(share, edge), axis=1))
    return best


def entries(steps, points, low, high):
    """How often a cut went into a box: runs of frames with a cut point inside it. Returns entries, points inside."""
    inside = ((numpy.asarray(points) >= low) & (numpy.asarray(points) <= high)).all(axis=1)
    frames = sorted({step for step, is_in in zip(steps, inside) if is_in})
    # A blade that stays inside cuts in most frames; a tenth of a second without is a new entry.
    return sum(1 for i, step in enumerate(frames) if i == 0 or step - frames[i - 1] > 6), int(inside.sum())
