#!/usr/bin/python3
"""A session under load, measured: frames dropped, samples used, latency, memory, CPU.

    long_session.py [--seconds 600] [--nodelet] [--scene FILE] [--rate 1000] [--reset-every 60] [--check]

Starts a master and a simulator of its own, plays strokes over and over (tool_player), resets now and then, and reads
what is published. Latency: from the stamp of the newest tool sample that a frame used (~inputs) to the receipt of the
frame's positions. Late: frames whose computation took longer than they last. Memory: resident, of the simulator alone;
at each reset it gives back what is free, so that the least it holds right after one, in the second third of the time and
in the last, tells what it has lost for good, whatever it needs in between. Prints a line a minute and a row for a table at
the end. --check: exit status 1 when a frame or a sample is missing, or the simulator has grown.
"""
import argparse
import os
import random
import struct
import subprocess
import sys
import threading
import time

HERE = os.path.dirname(os.path.realpath(__file__))
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--seconds", type=float, default=600)
parser.add_argument("--rate", type=float, default=1000, help="samples of the tool per second")
parser.add_argument("--scene", default=os.path.join(HERE, "..", "launch", "block.yaml"))
parser.add_argument("--strokes", default=os.path.join(HERE, "..", "launch", "block_strokes.yaml"))
parser.add_argument("--reset-every", type=float, default=60, help="seconds; 0: never")
parser.add_argument("--nodelet", action="store_true", help="the simulator as a nodelet")
parser.add_argument("--check", action="store_true", help="fail when something is lost or grows")
arguments = parser.parse_args()
os.environ["ROS_MASTER_URI"] = f"http://localhost:{random.randrange(20000, 32000)}"
os.environ["ROS_HOSTNAME"] = "localhost"

import rospy  # noqa: E402
from meshless_cutting.msg import FrameInput, StepStatistics  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

# Memory that is lost for good counts from this much on: pages that are shared out otherwise than before, and messages
# that are on their way.
GROWTH_MB = 2.0


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def quantiles(values):
    return f"{1e3 * percentile(values, 0.5):.1f} / {1e3 * percentile(values, 0.99):.1f} ms"


def memory_and_cpu(pid):
    """Resident memory, MB, and CPU time, s, of a process."""
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    ticks = os.sysconf("SC_CLK_TCK")
    return int(fields[21]) * os.sysconf("SC_PAGE_SIZE") / 1e6, (int(fields[11]) + int(fields[12])) / ticks


def session_and_step(message):
    """Of SurfacePositions as it came in: header (seq, stamp, frame), object, session, version, step."""
    data = message._buff
    at = 12
    for _ in range(2):  # frame_id, object
        at += 4 + struct.unpack_from("<I", data, at)[0]
    session, _, step = struct.unpack_from("<IIQ", data, at)
    return session, step


class Listener:
    """What came in since take() was called last, and over all."""

    def __init__(self):
        self.lock = threading.Lock()
        self.newest = {}  # (session, step) -> stamp of the newest sample, s
        self.received = {}  # (session, step) -> when its positions came in, s
        self.latencies, self.times = [], []
        self.frames = self.lost = self.late = self.samples = self.missing = 0
        self.newest_sample = (0, 0.0, 0.0)  # session, stamp s, height m
        self.last = None
        options = {"queue_size": 1000, "tcp_nodelay": True, "buff_size": 1 << 24}
        self.subscribers = [
            rospy.Subscriber("/simulator/inputs", FrameInput, self.on_input, **options),
            rospy.Subscriber("/simulator/statistics", StepStatistics, self.on_statistics, **options),
            rospy.Subscriber("/simulator/surface/positions", rospy.AnyMsg, self.on_positions, **options)]

    def on_input(self, message):
        with self.lock:
            self.samples += len(message.sample_stamp)
            for i, stamp in enumerate(message.sample_stamp):
                # The player's stamps lie on a grid; from one play to the next it pauses, and jumps back up.
                sample = (message.session, stamp.to_sec(), message.sample_pose[7 * i + 2])
                before, self.newest_sample = self.newest_sample, sample
                if sample[0] == before[0] and sample[2] < before[2] + 0.05:
                    self.missing += max(0, round((sample[1] - before[1]) * arguments.rate) - 1)
            if message.sample_stamp:
                self.pair(self.newest, (message.session, message.step), max(s.to_sec() for s in message.sample_stamp))

    def on_statistics(self, message):
        with self.lock:
            self.times.append(message.total_s)
            self.late += message.missed

    def on_positions(self, message):
        now = rospy.get_time()
        key = session_and_step(message)
        if key[1] == 0:
            return
        with self.lock:
            self.frames += 1
            if self.last and self.last[0] == key[0]:
                self.lost += key[1] - self.last[1] - 1
            self.last = key
            self.pair(self.received, key, now)

    def pair(self, store, key, value):
        store[key] = value
        if key in self.newest and key in self.received:
            self.latencies.append(self.received.pop(key) - self.newest.pop(key))
        for old in list(store)[:-200]:  # without a sample, or from before the start
            del store[old]


def start(*command):
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main():
    port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]
    running = [start("roscore", "-p", port)]
    try:
        rospy.init_node("long_session", disable_signals=True)
        program = ["nodelet", "nodelet", "standalone", "meshless_cutting/Simulator"] if arguments.nodelet else [
            "meshless_cutting", "simulator"]
        simulator = start("rosrun", *program, "__name:=simulator", "_scene:=" + os.path.realpath(arguments.scene))
        running.append(simulator)
        rospy.wait_for_service("/simulator/reset", 120)
        reset = rospy.ServiceProxy("/simulator/reset", Trigger)
        listener = Listener()
        while not all(subscriber.get_num_connections() for subscriber in listener.subscribers):
            time.sleep(0.1)
        player = start("rosrun", "meshless_cutting", "tool_player", "_path:=" + os.path.realpath(arguments.strokes),
                       "_topic:=/simulator/scalpel/measured_cp", f"_rate:={arguments.rate}", "_loop:=true")
        running.append(player)
        time.sleep(2)
        begin = time.time()
        cpu_at_start = memory_and_cpu(simulator.pid)[1]
        samples_at_start = listener.samples
        memory, after_reset = [], []
        next_line, next_reset = begin + 60, begin + (arguments.reset_every or float("inf"))
        while time.time() - begin < arguments.seconds:
            time.sleep(1)
            if simulator.poll() is not None or player.poll() is not None:
                sys.exit("the simulator or the player has ended")
            now, cpu = memory_and_cpu(simulator.pid)
            memory.append(now)
            if time.time() >= next_line:
                next_line += 60
                with listener.lock:
                    print(f"{time.time() - begin:5.0f} s: {listener.frames} frames, {listener.lost} lost, {listener.late} late, "
                          f"{listener.samples - samples_at_start} samples, {listener.missing} missing, frame {quantiles(listener.times)}, latency "
                          f"{quantiles(listener.latencies)}, {now:.1f} MB, CPU {cpu - cpu_at_start:.0f} s, load "
                          f"{os.getloadavg()[0]:.1f}", flush=True)
            if time.time() >= next_reset:
                next_reset += arguments.reset_every
                reset()
                after_reset.append(memory_and_cpu(simulator.pid)[0])
        seconds = time.time() - begin
        cpu = memory_and_cpu(simulator.pid)[1] - cpu_at_start
        after_reset = after_reset or memory
        third = len(after_reset) // 3
        least = [min(after_reset[third:2 * third] or after_reset), min(after_reset[2 * third:])]
        with listener.lock:
            samples = listener.samples - samples_at_start
            print(f"| {'nodelet' if arguments.nodelet else 'node'} | {seconds:.0f} s | {listener.frames} "
                  f"({listener.frames / (seconds + 2):.1f} Hz) | {listener.lost} | {listener.late} | {samples / seconds:.0f} | {listener.missing} | "
                  f"{quantiles(listener.times)} | {quantiles(listener.latencies)} | {least[0]:.1f} -> "
                  f"{least[1]:.1f}, at most {max(memory):.1f} MB | {100 * cpu / seconds:.0f} % | {os.getloadavg()[0]:.1f} |")
            failed = listener.lost > 0 or listener.missing > 0 or least[1] - least[0] > GROWTH_MB
        return 1 if arguments.check and failed else 0
    finally:
        for process in reversed(running):
            process.send_signal(2)
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:
                process.kill()


if __name__ == "__main__":
    sys.exit(main())
