#!/usr/bin/python3
"""Prints what was cut in a bag of the simulator: strokes, fragments, frame times.

    demo_report.py BAG [--from SECONDS]

--from leaves the first seconds of simulated time out of the frame times (start-up).
"""
import argparse

import rosbag

STARTED, PROGRESS, ENDED, SEPARATED, JUMP_REFUSED = range(5)


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('bag')
    parser.add_argument('--from', dest='start_s', type=float, default=1.0)
    arguments = parser.parse_args()

    frames, last, first_stamp, volumes, cutting = [], None, None, [], set()
    strokes, open_strokes = [], {}
    with rosbag.Bag(arguments.bag) as bag:
        for topic, message, _ in bag.read_messages():
            if topic.endswith('/statistics'):
                first_stamp = first_stamp or message.header.stamp
                frames.append(((message.header.stamp - first_stamp).to_sec(), message.step, message.total_s,
                               message.cut_s + message.find_crossings_s, message.missed, message.status))
                last = message
            elif topic.endswith('/cut_events'):
                key = (message.tool, message.stroke)
                if message.event in (STARTED, PROGRESS):
                    cutting.add(message.step)
                    stroke = open_strokes.setdefault(key, {'links': 0, 'area': 0.0, 'length': 0.0, 'depth': 0.0})
                    stroke['links'] += message.links_cut
                    stroke['area'] += message.area_m2
                    stroke['length'], stroke['depth'] = message.length_m, message.depth_m
                elif message.event == SEPARATED:
                    volumes = list(message.fragment_volume_m3)
                if message.event == ENDED:  # carries the sums, also of what was cut before the recording began
                    open_strokes.pop(key, None)
                    strokes.append((key, {'links': message.links_cut, 'area': message.area_m2,
                                          'length': message.length_m, 'depth': message.depth_m}))
    strokes += list(open_strokes.items())
    if last is None:
        raise SystemExit(arguments.bag + ': no topic ends with /statistics; expected a bag recorded from the simulator')

    print('strokes')
    print('  tool       no.   links   length mm   depth mm   area mm2')
    for (tool, number), stroke in strokes:
        print('  %-10s %3d  %6d   %9.1f  %9.1f  %9.1f' % (tool, number, stroke['links'], 1e3 * stroke['length'],
                                                          1e3 * stroke['depth'], 1e6 * stroke['area']))
    print('fragments: %d' % last.fragments)
    for index, volume in enumerate(volumes):
        print('  %d: %.3f ml' % (index, 1e6 * volume))
    print('tissue: %d particles, %d integration points, %d links (%d cut), %d vertices, %d triangles' %
          (last.particles, last.integration_points, last.links, last.links_cut, last.vertices, last.triangles))

    timed = [f for f in frames if f[0] >= arguments.start_s]
    for name, chosen in (('all frames', timed), ('frames that cut', [f for f in timed if f[1] in cutting])):
        if chosen:
            total, cut = [1e3 * f[2] for f in chosen], [1e3 * f[3] for f in chosen]
            print('%s: %d, time p50 %.1f p99 %.1f max %.1f ms; of that search and cut p50 %.2f p99 %.2f ms; '
                  'deadline of %.1f ms missed %d times' %
                  (name, len(chosen), percentile(total, 0.5), percentile(total, 0.99), max(total), percentile(cut, 0.5),
                   percentile(cut, 0.99), 1e3 * last.deadline_s, sum(f[4] for f in chosen)))
    for bit, name in ((1, 'not converged'), (2, 'rolled back'), (4, 'frozen')):
        count = sum(1 for f in frames if f[5] & bit)
        if count:
            print('frames %s: %d' % (name, count))


if __name__ == '__main__':
    main()
