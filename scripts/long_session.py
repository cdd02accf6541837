#!/usr/bin/python3
"""A session under load, measured: frames dropped, latency, memory, CPU.

    long_session.py [--seconds 600] [--nodelet] [--scene FILE] [--rate 1000]

Starts a master and the simulator of its own, plays strokes at 1 kHz over and over (tool_player), resets every 60 s, and
reads what is published. Latency: from the stamp of the newest tool sample that a frame used
(~statistics, input_until) to the receipt of its positions. Prints one line per minute and a table at the end.
"""
import argparse
import os
import random
import subprocess
import sys
import threading
import time

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--seconds", type=float, default=600)
parser.add_argument("--rate", type=float, default=1000, help="samples of the tool per second")
parser.add_argument("--scene", default=os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "launch", "block.yaml"))
parser.add_argument("--strokes", default=os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "launch",
                                                      "block_strokes.yaml"))
parser.add_argument("--nodelet", action="store_true", help="the simulator as a nodelet")
arguments = parser.parse_args()
port = random.randrange(20000, 40000)
os.environ["ROS_MASTER_URI"] = f"http://localhost:{port}"
os.environ["ROS_HOSTNAME"] = "localhost"

import rospy  # noqa: E402
from meshless_cutting.msg import StepStatistics, SurfacePositions  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402


def percentile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def memory_and_cpu(pid):
    """Resident memory, MB, and CPU time, s, of a process."""
    fields = open(f"/proc/{pid}/stat").read().rsplit(")", 1)[1].split()
    ticks = os.sysconf("SC_CLK_TCK")
    return int(fields[21]) * os.sysconf("SC_PAGE_SIZE") / 1e6, (int(fields[11]) + int(fields[12])) / ticks


class Session:
    def __init__(self):
        self.lock = threading.Lock()
        self.stamps = {}  # (session, step) -> input_until, s
        self.received = {}
        self.latencies, self.frames, self.lost, self.missed, self.last = [], 0, 0, 0, None
        rospy.Subscriber("/simulator/statistics", StepStatistics, self.on_statistics, queue_size=1000, tcp_nodelay=True)
        rospy.Subscriber("/simulator/surface/positions", SurfacePositions, self.on_positions, queue_size=1000,
                         tcp_nodelay=True, buff_size=1 << 24)

    def on_statistics(self, message):
        with self.lock:
            self.missed += message.missed
            self.pair((message.session, message.step), message.input_until.to_sec(), None)

    def on_positions(self, message):
        now = rospy.get_time()
        key = (message.session, message.step)
        with self.lock:
            if message.step == 0:
                return
            self.frames += 1
            if self.last and self.last[0] == key[0] and key[1] > self.last[1] + 1:
                self.lost += key[1] - self.last[1] - 1
            self.last = key
            self.pair(key, None, now)

    def pair(self, key, stamp, now):
        at = self.received.setdefault(key, [None, None])
        at[0] = stamp if stamp is not None else at[0]
        at[1] = now if now is not None else at[1]
        if None not in at:
            self.latencies.append(at[1] - at[0])
            del self.received[key]
            for old in list(self.received)[:-100]:
                del self.received[old]


def main():
    core = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    command = (["rosrun", "nodelet", "nodelet", "standalone", "meshless_cutting/Simulator"] if arguments.nodelet else
               ["rosrun", "meshless_cutting", "simulator"])
    simulator = player = None
    try:
        rospy.init_node("long_session", disable_signals=True)
        simulator = subprocess.Popen(command + ["__name:=simulator", "_scene:=" + os.path.realpath(arguments.scene)],
                                     stdout=subprocess.DEVNULL)
        rospy.wait_for_service("/simulator/reset", 60)
        reset = rospy.ServiceProxy("/simulator/reset", Trigger)
        player = subprocess.Popen(["rosrun", "meshless_cutting", "tool_player",
                                   "_path:=" + os.path.realpath(arguments.strokes),
                                   "_topic:=/simulator/scalpel/measured_cp", f"_rate:={arguments.rate}", "_loop:=true"],
                                  stdout=subprocess.DEVNULL)
        time.sleep(2)
        session = Session()
        start, memory = time.time(), []
        cpu_at_start = memory_and_cpu(simulator.pid)[1]
        while time.time() - start < arguments.seconds:
            time.sleep(max(0.1, min(60, start + arguments.seconds - time.time())))
            if simulator.poll() is not None or player.poll() is not None:
                sys.exit("the simulator or the player has ended")
            now, cpu = memory_and_cpu(simulator.pid)
            memory.append(now)
            with session.lock:
                print(f"{time.time() - start:6.0f} s: {session.frames} frames, {session.lost} lost, {session.missed} late, "
                      f"memory {now:.1f} MB, CPU {cpu:.0f} s, latency p50 {1e3 * percentile(session.latencies, 0.5):.2f} ms, "
                      f"p99 {1e3 * percentile(session.latencies, 0.99):.2f} ms", flush=True)
            reset()
        seconds = time.time() - start
        cpu = memory_and_cpu(simulator.pid)[1] - cpu_at_start
        with session.lock:
            print(f"| {'nodelet' if arguments.nodelet else 'node'} | {seconds:.0f} s | {session.frames} "
                  f"({session.frames / seconds:.1f} Hz) | {session.lost} | {session.missed} | "
                  f"{1e3 * percentile(session.latencies, 0.5):.2f} / {1e3 * percentile(session.latencies, 0.99):.2f} ms | "
                  f"{memory[0]:.1f} -> {memory[-1]:.1f} MB | {100 * cpu / seconds:.0f} % |")
        return 0 if session.lost == 0 else 1
    finally:
        for process in (player, simulator, core):
            if process:
                process.send_signal(2)
                process.wait(15)


if __name__ == "__main__":
    sys.exit(main())
