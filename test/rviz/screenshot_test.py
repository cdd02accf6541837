#!/usr/bin/python3
"""rviz with the plugin on a virtual screen: what it draws is counted in pixels by colour."""
import os
import subprocess
import sys
import time
import unittest

import numpy
import rospy
import rostest
from meshless_cutting.msg import SurfacePositions, SurfaceTopology

WIDTH, HEIGHT = 1000, 700
CENTRES = {"left": -0.36, "middle": 0.0, "right": 0.36}  # m, along x


def plates(shift, height=0.1):
    """Two boxes side by side; the top of the second is cut face, and it is fragment 1. Vertices, triangles, ..."""
    corner = numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
    faces = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6],
             [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    size = numpy.array([0.09, 0.2, height])
    vertices = numpy.vstack([corner * size - [0.1, 0.1, 0], corner * size + [0.01, -0.1, 0]]) + [shift, 0, 0]
    triangles = numpy.vstack([faces, numpy.array(faces) + 8])
    region = [0] * 12 + [0, 0, 1, 1] + [0] * 8
    return vertices, triangles, region, [0] * 12 + [1] * 12


class Surface:
    """Publishes one of the three."""

    def __init__(self, name):
        self.topology = rospy.Publisher(name + "/topology", SurfaceTopology, queue_size=10)
        self.positions = rospy.Publisher(name + "/positions", SurfacePositions, queue_size=10)

    def send_topology(self, session, version, mesh):
        vertices, triangles, region, fragment = mesh
        message = SurfaceTopology(object="test", session=session, version=version)
        message.header.frame_id = "world"
        message.triangles = triangles.ravel().tolist()
        message.region, message.fragment = bytes(region), fragment
        message.rest_positions = vertices.ravel().tolist()
        message.rest_pose.orientation.w = 1
        self.topology.publish(message)

    def send_positions(self, session, version, vertices):
        message = SurfacePositions(object="test", session=session, version=version)
        message.header.frame_id, message.header.stamp = "world", rospy.Time.now()
        message.positions = numpy.asarray(vertices).ravel().tolist()
        self.positions.publish(message)


class Picture:
    """Pixels of the screen, counted by colour per third."""

    def __init__(self, display):
        raw = subprocess.check_output(["import", "-display", display, "-window", "root", "-depth", "8", "rgb:-"])
        self.rgb = numpy.frombuffer(raw, numpy.uint8).reshape(HEIGHT, WIDTH, 3).astype(int)

    def count(self, third, high, low):
        """Pixels in whose colour each channel of `high` is 60 above each of `low`; without the bars."""
        part = self.rgb[70:HEIGHT - 40, third * WIDTH // 3:(third + 1) * WIDTH // 3]
        return int((part[:, :, high].min(axis=2) > part[:, :, low].max(axis=2) + 60).sum())

    def red(self, third):
        return self.count(third, [0], [1, 2])

    def green(self, third):
        return self.count(third, [1], [0, 2])

    def blue(self, third):
        return self.count(third, [2], [0])

    def magenta(self, third):
        return self.count(third, [0, 2], [1])

    def background(self):
        return int((numpy.abs(self.rgb - [20, 40, 60]).max(axis=2) < 6).sum())


class ScreenshotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        read, write = os.pipe()
        cls.xvfb = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "+extension",
                                     "GLX", "-noreset"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:  # a whole line: then the screen takes connections
            cls.display = ":" + number.readline().strip()
        environment = dict(os.environ, DISPLAY=cls.display, LIBGL_ALWAYS_SOFTWARE="1", QT_X11_NO_MITSHM="1",
                           XDG_RUNTIME_DIR=os.environ.get("XDG_RUNTIME_DIR", "/tmp"))
        config = os.path.join(os.path.dirname(os.path.realpath(__file__)), "screenshot.rviz")
        cls.rviz = subprocess.Popen(["rosrun", "rviz", "rviz", "-d", config], env=environment)
        cls.surfaces = {name: Surface("/" + name) for name in CENTRES}

    @classmethod
    def tearDownClass(cls):
        if "SCREENSHOT_TEST_OUT" in os.environ:  # to look at
            subprocess.call(["import", "-display", cls.display, "-window", "root", os.environ["SCREENSHOT_TEST_OUT"]])
        for process in (cls.rviz, cls.xvfb):
            process.terminate()
        for process in (cls.rviz, cls.xvfb):
            process.wait()

    def until(self, holds, seconds=20):
        """The first picture for which it holds, else the last."""
        end = time.time() + seconds
        while True:
            picture = Picture(self.display)
            if holds(picture) or time.time() > end or self.rviz.poll() is not None:
                return picture
            time.sleep(0.3)

    def test_what_is_drawn(self):
        left, middle, right = (self.surfaces[name] for name in ("left", "middle", "right"))
        picture = self.until(lambda p: p.background() > 0.5 * WIDTH * HEIGHT, 90)
        self.assertGreater(picture.background(), 0.5 * WIDTH * HEIGHT, "rviz is up")
        self.until(lambda _: all(s.positions.get_num_connections() and s.topology.get_num_connections()
                                 for s in self.surfaces.values()))
        self.assertEqual(picture.red(0) + picture.green(0), 0, "nothing was published")

        mesh = plates(CENTRES["left"])
        left.send_positions(1, 1, mesh[0])
        time.sleep(1)
        self.assertEqual(Picture(self.display).red(0), 0, "positions wait for their topology")
        left.send_topology(1, 1, mesh)
        picture = self.until(lambda p: p.red(0) > 5000)
        # Seen from above at 900 pixels a metre each top is 81 by 180 pixels.
        self.assertGreater(picture.red(0), 0.8 * 81 * 180)
        self.assertLess(picture.red(0), 1.3 * 81 * 180)
        self.assertGreater(picture.green(0), 0.8 * 81 * 180, "the cut face has its own colour")

        # A new session with a thinner object: the old picture stays until its topology is there.
        small = (mesh[0] * [1, 0.3, 1], *mesh[1:])
        left.send_positions(2, 1, small[0])
        time.sleep(1)
        self.assertGreater(Picture(self.display).red(0), 0.8 * 81 * 180)
        left.send_topology(2, 1, small)
        picture = self.until(lambda p: p.red(0) < 0.4 * 81 * 180)
        self.assertLess(picture.red(0), 0.4 * 81 * 180)
        self.assertGreater(picture.red(0), 0.2 * 81 * 180)

        # A seek back in a bag.
        left.send_positions(1, 1, mesh[0])
        picture = self.until(lambda p: p.red(0) > 0.8 * 81 * 180)
        self.assertGreater(picture.red(0), 0.8 * 81 * 180)

        # What cannot be drawn is refused; the picture stays and rviz lives.
        bad = (mesh[0], mesh[1] + 1000, *mesh[2:])
        left.send_topology(1, 2, bad)
        left.send_positions(1, 2, mesh[0])
        left.send_positions(1, 1, mesh[0] * numpy.nan)
        left.send_positions(1, 1, mesh[0][:4])
        time.sleep(1)
        self.assertGreater(Picture(self.display).red(0), 0.8 * 81 * 180)
        self.assertIsNone(self.rviz.poll(), "rviz lives")

        mesh = plates(CENTRES["middle"])
        middle.send_topology(1, 1, mesh)
        middle.send_positions(1, 1, mesh[0])
        picture = self.until(lambda p: p.red(1) > 5000)
        self.assertGreater(picture.red(1), 0.8 * 81 * 180, "the largest fragment keeps its colour")
        self.assertEqual(picture.green(1), 0)
        self.assertGreater(picture.blue(1), 0.8 * 81 * 180, "the other has one of its own")

        # At rest the plates lie where they were, whatever the positions say.
        mesh = plates(CENTRES["right"])
        right.send_topology(1, 1, mesh)
        right.send_positions(1, 1, mesh[0] + [0, 5, 0])
        picture = self.until(lambda p: p.magenta(2) > 300)
        # Edges and diagonals of two rectangles, one pixel wide.
        self.assertGreater(picture.magenta(2), 800)
        self.assertLess(picture.magenta(2), 4000)


if __name__ == "__main__":
    rospy.init_node("screenshot_test")
    rostest.rosrun("meshless_cutting", "screenshot", ScreenshotTest, sys.argv)
