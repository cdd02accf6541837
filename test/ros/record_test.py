#!/usr/bin/python3
"""A live run is recorded with record.launch; from its bag `replay --as-recorded` makes the same bits, bag_report reads
it, a bag entered in the middle shows a mesh within a second, and `rosbag play --clock` cuts the same."""
import csv
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rosbag
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from meshless_cutting.msg import StepStatistics
from std_srvs.srv import Trigger

HERE = os.path.dirname(os.path.realpath(__file__))
SCENE = os.path.join(HERE, "data", "block_assessed.yaml")
FOLDER = tempfile.mkdtemp()
BAG = os.path.join(FOLDER, "live.bag")


def positions(path):
    """All positions by (session, step)."""
    with rosbag.Bag(path) as bag:
        return {(m.session, m.step): m for _, m, _ in bag.read_messages(topics=["/simulator/surface/positions"])}


def last(path):
    with rosbag.Bag(path) as bag:
        return [m for _, m, _ in bag.read_messages(topics=["/simulator/statistics"])][-1]


def run(*command):
    return subprocess.run(["rosrun", "meshless_cutting", *command], capture_output=True, text=True)


def stop(process):
    """As Ctrl-C; one that does not end is killed, so that a failure is seen and not waited for."""
    process.send_signal(signal.SIGINT)
    try:
        process.wait(20)
    except subprocess.TimeoutExpired:
        process.kill()


class RecordTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service("/simulator/reset", 60)
        recorder = subprocess.Popen(["roslaunch", "meshless_cutting", "record.launch", "bag:=" + BAG,
                                     "drivers:=|/simulator/scalpel/.*"])
        poses = rospy.Publisher("/simulator/scalpel/measured_cp", PoseStamped, queue_size=1000)
        end = time.time() + 60
        while poses.get_num_connections() < 2 and time.time() < end:  # the simulator and the recorder
            time.sleep(0.1)
        time.sleep(1)
        rospy.ServiceProxy("/simulator/reset", Trigger)()
        start = rospy.Time.now() + rospy.Duration(0.2)
        for i in range(101):
            pose = PoseStamped()
            pose.header.stamp, pose.header.frame_id = start + rospy.Duration(i / 200.0), "world"
            pose.pose.position.x, pose.pose.position.z = 0.0627, 0.06 - 0.0009 * i
            pose.pose.orientation.w = 1
            rospy.sleep(pose.header.stamp - rospy.Time.now())
            poses.publish(pose)
        time.sleep(3)  # more than a second is left after 0.7 of the bag
        stop(recorder)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)

    def test_1_replay_as_recorded_is_live_to_the_bit(self):
        again = os.path.join(FOLDER, "again.bag")
        result = run("replay", "--scene", SCENE, "--input", BAG, "--output", again, "--as-recorded")
        self.assertEqual(result.returncode, 0, result.stderr)
        live, replayed = positions(BAG), positions(again)
        steps = [key for key in replayed if key[1] > 0]
        self.assertGreater(len(steps), 60)
        for key in steps:
            self.assertEqual(live[key].positions, replayed[key].positions, key)
            self.assertEqual(live[key].version, replayed[key].version, key)
            self.assertEqual(live[key].header.stamp, replayed[key].header.stamp, key)
        self.assertEqual(last(again).fragments, 2)

    def test_2_from_the_drivers_topics_the_cuts_are_the_same(self):
        offline = os.path.join(FOLDER, "offline.bag")
        result = run("replay", "--scene", SCENE, "--input", BAG, "--output", offline)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(last(offline).fragments, 2)
        self.assertAlmostEqual(last(offline).links_cut, last(BAG).links_cut, delta=0.02 * last(BAG).links_cut)

    def test_3_a_bag_entered_in_the_middle_has_its_mesh_within_a_second(self):
        """A second of simulated time, whatever the machine made of it."""
        with rosbag.Bag(BAG) as bag:
            begin, end = bag.get_start_time(), bag.get_end_time()
            for share in (0.3, 0.5, 0.7):
                known, unknown, shown = set(), 0, False
                for topic, message, _ in bag.read_messages(topics=["/simulator/surface/topology", "/simulator/surface/positions"],
                                                           start_time=rospy.Time(begin + share * (end - begin))):
                    if topic.endswith("topology"):
                        known.add((message.session, message.version))
                    elif (message.session, message.version) in known:
                        shown = True
                        break
                    else:
                        unknown += 1
                self.assertTrue(shown, share)
                self.assertLessEqual(unknown, 51, share)

    def test_4_the_report(self):
        out = os.path.join(FOLDER, "report")
        result = run("bag_report", BAG, "--out", out)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(out, "strokes.csv"), newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 1, result.stdout)
        row = {key: float(value) for key, value in rows[0].items() if key not in ("tool", "forbidden_zones")}
        self.assertEqual(rows[0]["tool"], "scalpel")
        self.assertAlmostEqual(row["length_m"], 0.04, delta=0.012)  # the block is 0.04 high
        self.assertAlmostEqual(row["depth_m"], 0.04, delta=0.012)
        self.assertAlmostEqual(row["area_m2"], 0.0016, delta=0.0005)
        self.assertAlmostEqual(row["mean_speed_m_s"], 0.18, delta=0.02)
        self.assertAlmostEqual(row["tip_path_m"], row["duration_s"] * 0.18, delta=0.005)
        self.assertEqual(row["fragments_freed"], 1)
        self.assertLess(row["deviation_max_m"], 0.005)  # planned at x = 0.0627; links are 0.01 long
        self.assertEqual(row["forbidden_entries"], 1)
        self.assertEqual(rows[0]["forbidden_zones"], "vein")
        self.assertTrue(math.isfinite(row["ldlj"]))  # at constant speed there is next to no jerk
        self.assertLess(row["sparc"], -1)
        page = open(os.path.join(out, "report.html"), encoding="utf-8").read()
        self.assertEqual(page.count("<img"), 2)
        self.assertNotEqual(run("bag_report", os.path.join(FOLDER, "none.bag")).returncode, 0)

    def test_5_played_with_its_clock_it_cuts_the_same(self):
        """A second master: there time is simulated."""
        port = 20000 + os.getpid() % 20000
        environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_IP="127.0.0.1")
        out = os.path.join(FOLDER, "clock.bag")
        # Not that of the launch file, which ends with it: a recorder without master does not always close its bag.
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], env=environment)
        while subprocess.run(["rosparam", "list"], env=environment, capture_output=True).returncode:
            time.sleep(0.2)
        launch = subprocess.Popen(
            ["roslaunch", "-p", str(port), "meshless_cutting", "replay.launch", "recompute:=true", "rviz:=false",
             "bag:=" + BAG, "scene:=" + SCENE], env=environment)
        while subprocess.run(["rosparam", "get", "/use_sim_time"], env=environment, capture_output=True).returncode:
            time.sleep(0.2)
        recorder = subprocess.Popen(["rosbag", "record", "-O", out, "/simulator/statistics"], env=environment)
        watchdog = threading.Timer(120, launch.kill)
        watchdog.start()
        launch.wait()  # the player is required
        watchdog.cancel()
        stop(recorder)
        stop(master)
        self.assertTrue(os.path.exists(out), os.listdir(FOLDER))
        self.assertEqual(last(out).fragments, 2)
        self.assertAlmostEqual(last(out).links_cut, last(BAG).links_cut, delta=0.02 * last(BAG).links_cut)


if __name__ == "__main__":
    rospy.init_node("record_test")
    rostest.rosrun("meshless_cutting", "record", RecordTest, sys.argv)
