#!/usr/bin/python3
"""A launch file with what its user brings: a driver's messages, as that driver sends them. It must cut, or as its figure says.

    launch_test.py CASE

Starts a master of its own; the types, topics, frames and rates of the drivers are those of the README's table.
"""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

os.environ["ROS_MASTER_URI"] = f"http://localhost:{random.randrange(20000, 32000)}"
os.environ["ROS_HOSTNAME"] = "localhost"

import rosbag  # noqa: E402
import rospy  # noqa: E402
from geometry_msgs.msg import PoseStamped, TransformStamped  # noqa: E402
from meshless_cutting.msg import StepStatistics  # noqa: E402
from sensor_msgs.msg import Joy  # noqa: E402
from visualization_msgs.msg import InteractiveMarkerFeedback  # noqa: E402

PATIENCE = 120  # s, for anything that is waited for
FIGURES = ["situation_1", "situation_2", "situation_3", "fig7_falling_cylinder", "fig8_rising_edge", "fig9_twisting_blade",
           "fig11_liver", "fig12_mapping"]
UNCUT = "situation_2"  # the blade has passed before the object comes


class Driver:
    """Plays the liver's first stroke as a device does: its topic, type, rate; its frame, whose origin is at `base`."""

    def __init__(self, topic, message=PoseStamped, rate=1000, frame="", base=(0, 0, 0.02), stamped=True):
        self.topic, self.message, self.rate, self.frame, self.base, self.stamped = topic, message, rate, frame, base, stamped

    def advertise(self):
        self.publisher = rospy.Publisher(self.topic, self.message, queue_size=1000)
        bag = os.path.join(tempfile.mkdtemp(), "strokes.bag")
        subprocess.run(["rosrun", "meshless_cutting", "tool_player", "--path", "package://meshless_cutting/launch/liver_strokes.yaml",
                        "--bag", bag, "--rate", str(self.rate)], check=True, stdout=subprocess.DEVNULL)
        with rosbag.Bag(bag) as poses:
            self.poses = [message.pose for _, message, _ in poses.read_messages()][int(1.2 * self.rate):int(3.6 * self.rate)]
        os.remove(bag)

    def send(self, index, stamp):
        pose, message = self.poses[index], self.message()
        message.header.frame_id = self.frame
        message.header.stamp = stamp if self.stamped else rospy.Time()
        p = pose.position.x - self.base[0], pose.position.y - self.base[1], pose.position.z - self.base[2]
        if self.message is PoseStamped:
            message.pose.position.x, message.pose.position.y, message.pose.position.z = p
            message.pose.orientation = pose.orientation
        elif self.message is TransformStamped:
            message.transform.translation.x, message.transform.translation.y, message.transform.translation.z = p
            message.transform.rotation = pose.orientation
        self.publisher.publish(message)


class Marker(Driver):
    """rviz, whose user drags the interactive marker."""

    def __init__(self):
        super().__init__("/tool_marker/feedback", InteractiveMarkerFeedback, rate=60)

    def send(self, index, stamp):
        feedback = InteractiveMarkerFeedback(client_id="rviz", marker_name="tool", pose=self.poses[index],
                                             event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        feedback.header.frame_id, feedback.header.stamp = "world", stamp
        self.publisher.publish(feedback)


class Pedal:
    """A foot pedal that is held down."""

    def __init__(self, topic):
        self.topic = topic

    def advertise(self):
        self.publisher = rospy.Publisher(self.topic, Joy, queue_size=10, latch=True)

    def press(self):
        joy = Joy(buttons=[1])
        joy.header.stamp = rospy.Time.now()
        self.publisher.publish(joy)


PSM1, PSM2 = (0.20, -0.25, 0.15), (-0.20, -0.25, 0.15)  # bases in two_arm_cell.urdf
CASES = {
    "omni": (["omni.launch"], [Driver("/omni1_pose", rate=500, frame="/omni1_base", stamped=False)]),
    "geomagic": (["geomagic.launch"], [Driver("/phantom/pose", frame="map")]),
    "haptic": (["haptic.launch", "topic:=/sigma7/measured_cp"], [Driver("/sigma7/measured_cp")]),
    "crtk_arm": (["crtk_arm.launch"], [Driver("/PSM1/measured_cp", rate=200, frame="ECM", base=PSM1),
                                       Driver("/PSM2/measured_cp", rate=200, base=PSM2), Pedal("/footpedals/coag")]),
    "raven": (["crtk_arm.launch", "arm1:=/arm1", "arm2:=/arm2"],
              [Driver("/arm1/measured_cp", TransformStamped, frame="base", base=PSM1), Pedal("/footpedals/coag")]),
    "tool_marker": (["tool_marker.launch"], [Marker()]),
    "simulator_nodelet": (["simulator.launch", "nodelet:=true"], [Driver("/simulator/scalpel/measured_cp", frame="world", base=(0, 0, 0))]),
    "liver": (["liver.launch"], []),
    "block": (["block.launch"], []),
    "brain": (["brain.launch"], []),
}
CASES.update({name: (["figure.launch", "figure:=" + name], []) for name in FIGURES})


def until(condition, what, alive):
    end = time.time() + PATIENCE
    while not condition():
        if time.time() > end or alive.poll() is not None:
            sys.exit("never: " + what)
        time.sleep(0.02)


def play(drivers, done, alive):
    """Strokes, stamped on a grid, over and over until they are done."""
    poses = [d for d in drivers if isinstance(d, Driver)]
    end = time.time() + PATIENCE
    while not done() and time.time() < end and alive.poll() is None:
        start = rospy.Time.now()
        sent = [0] * len(poses)
        while any(sent[i] < len(d.poses) for i, d in enumerate(poses)) and not done():
            elapsed = (rospy.Time.now() - start).to_sec()
            for i, driver in enumerate(poses):
                while sent[i] < len(driver.poses) and sent[i] / driver.rate <= elapsed:
                    driver.send(sent[i], start + rospy.Duration(sent[i] / driver.rate))
                    sent[i] += 1
            time.sleep(0.001)


def main():
    arguments, drivers = CASES[sys.argv[1]]
    port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]
    with tempfile.TemporaryFile("w+") as log:
        launch = subprocess.Popen(["roslaunch", "-p", port, "meshless_cutting", *arguments, "rviz:=false"], stdout=log,
                                  stderr=subprocess.STDOUT)
        try:
            until(lambda: subprocess.run(["rosparam", "get", "/simulator/scene"], capture_output=True).returncode == 0,
                  "a master", launch)
            rospy.init_node("launch_test", disable_signals=True)
            cut = {"links": 0, "step": 0}
            rospy.Subscriber("/simulator/statistics", StepStatistics, lambda message: cut.update(
                links=max(cut["links"], message.links_cut), step=message.step), queue_size=1000)
            for driver in drivers:
                driver.advertise()
            for driver in drivers:
                until(lambda: driver.publisher.get_num_connections() > 0, "a listener on " + driver.topic, launch)
                if isinstance(driver, Pedal):
                    driver.press()
            if any(isinstance(driver, Driver) for driver in drivers):
                play(drivers, lambda: cut["links"] > 20, launch)
            if sys.argv[1] == UNCUT:
                until(lambda: cut["step"] > 45, "45 frames", launch)
                if cut["links"]:
                    sys.exit(f"{cut['links']} links cut, expected none")
            else:
                until(lambda: cut["links"] > 20, "a cut", launch)
        finally:
            launch.send_signal(signal.SIGINT)  # also after a failure: killed, it would leave its nodes behind
            try:
                launch.wait(60)
            except subprocess.TimeoutExpired:
                launch.kill()
            log.seek(0)
            text = log.read()
            bad = [line for line in text.splitlines() if "ERROR" in line or "FATAL" in line or "has died" in line]
            print(text[-6000:] if bad or sys.exc_info()[0] else f"{sys.argv[1]}: {cut['links']} links cut")
        return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
