#!/usr/bin/python3
"""Draws the table of `study`: plot_study.py study.csv [folder]. Writes one SVG and one PNG per figure."""
import collections
import csv
import math
import pathlib
import re
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402

DEADLINE_MS = 1000 / 60
MARKERS = 'osD^v<>Pph'
plt.rcParams.update({'font.size': 9, 'axes.grid': True, 'grid.alpha': 0.3, 'lines.markersize': 4.5, 'lines.linewidth': 1.2,
                     'legend.fontsize': 7.5, 'figure.dpi': 150, 'savefig.bbox': 'tight', 'axes.axisbelow': True,
                     'svg.hashsalt': 'study', 'axes.spines.top': False, 'axes.spines.right': False})
TITLES = {'cantilever': 'cantilever: tip', 'stretch': 'clamped stretch 1.5: force', 'squeeze': 'clamped squeeze 0.7: force',
          'torsion': 'torsion 90°: torque', 'torsion_half_turn': 'torsion 180°: torque', 'cook': "Cook's panel: corner",
          'slit_beam': 'slit beam: mouth', 'slit_block': 'slit block: mouth'}


STAGES = ('crossings', 'cut', 'dynamics', 'surface')


def title_of(problem, ratio):
    return TITLES.get(problem, problem) + (f', ν {ratio:g}' if problem == 'cook' else '')


def number(text):
    return float(text) if text else math.nan


def read(path):
    lines = [line for line in open(path, encoding='utf-8')]
    header = [line[2:].strip() for line in lines if line.startswith('#')]
    rows = list(csv.DictReader(line for line in lines if not line.startswith('#')))
    for row in rows:
        for key in row:
            if key not in ('problem', 'material', 'solver', 'note'):
                row[key] = number(row[key])
    return header, rows


def base_case(rows):
    """Rows of the balance problems; of the cantilever the case that was run at all resolutions."""
    for row in rows:
        if row['solver'] != 'quasi_static':
            continue
        if row['problem'] == 'cantilever' and not (row['material'] == 'neo_hookean' and row['youngs_modulus_pa'] == 1e5
                                                   and row['poisson_ratio'] == 0.45):
            continue
        yield row


def by(rows, key):
    groups = collections.OrderedDict()
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def draw(axes, groups, x, y, label=lambda k: k):
    """One line a group; failed runs are drawn as crosses at the upper edge."""
    for n, (key, rows) in enumerate(groups.items()):
        good = sorted((r for r in rows if not r['failed'] and r[x] > 0 and r[y] > 0), key=lambda r: r[x])
        bad = [r for r in rows if r['failed'] and r[x] > 0]
        line, = axes.plot([r[x] for r in good], [100 * r[y] for r in good], '-' + MARKERS[n % len(MARKERS)], label=label(key))
        if bad:
            axes.plot([r[x] for r in bad], [0.97] * len(bad), 'x', color=line.get_color(), markersize=7,
                      transform=axes.get_xaxis_transform(), clip_on=False)


def deadline(axes):
    axes.axvline(DEADLINE_MS, color='0.35', linestyle='--', linewidth=1)
    axes.annotate('16.7 ms', (DEADLINE_MS, 0.02), xycoords=axes.get_xaxis_transform(), rotation=90, fontsize=7.5,
                  color='0.35', ha='right', va='bottom')


def save(figure, folder, name, header):
    figure.text(0.01, -0.08, ' · '.join(header), fontsize=5.5, color='0.45')
    for kind in ('svg', 'png'):
        figure.savefig(folder / f'{name}.{kind}', metadata={'Date': None} if kind == 'svg' else None)
    plt.close(figure)


def error_against_time(rows, folder, header):
    groups = by(base_case(rows), lambda r: (r['problem'], r['poisson_ratio']))
    figure, panes = plt.subplots(1, 2, figsize=(9, 3.6), sharex=True)
    for axes, column, title in zip(panes, ('error_discretisation', 'error_field'),
                                   ('value that the problem is judged by', 'displacement field, relative $L_2$ of samples')):
        draw(axes, groups, 'wall_ms_per_frame_p50', column, lambda k: title_of(*k))
        axes.set(xscale='log', yscale='log', xlabel='wall time per frame of 1/60 s, median [ms]',
                 ylabel='discretisation error [%]')
        axes.set_title(title, fontsize=9)
        deadline(axes)
    panes[1].legend(loc='center left', bbox_to_anchor=(1.01, 0.5), frameon=False)
    figure.subplots_adjust(wspace=0.28)
    save(figure, folder, 'error_against_time', header)


def convergence(rows, folder, header):
    groups = by(base_case(rows), lambda r: (r['problem'], r['poisson_ratio']))
    figure, axes = plt.subplots(figsize=(5.2, 3.6))
    draw(axes, groups, 'particles', 'error_discretisation', lambda k: title_of(*k))
    axes.set(xscale='log', yscale='log', xlabel='particles', ylabel='discretisation error [%]')
    axes.legend(loc='center left', bbox_to_anchor=(1.01, 0.5), frameon=False)
    save(figure, folder, 'convergence', header)


def solver_error(rows, folder, header):
    rows = [r for r in rows if r['error_solver'] > 0 or (r['failed'] and r['problem'] == 'cantilever')]
    sweep = [r for r in rows if r['particles'] > 2000]
    stiff = [r for r in rows if r['particles'] < 2000]
    figure, panes = plt.subplots(1, 2 if stiff else 1, figsize=(9 if stiff else 5.2, 3.6), squeeze=False)
    panes = panes[0]
    groups = by(sorted(sweep, key=lambda r: (r['youngs_modulus_pa'], r['poisson_ratio'], r['particles'])),
                lambda r: (r['particles'], r['youngs_modulus_pa'], r['poisson_ratio']))
    draw(panes[0], groups, 'wall_ms_per_frame_p50', 'error_solver',
         lambda k: f'{k[0]:,.0f} particles, {k[1] / 1e3:g} kPa, ν {k[2]:g}' if k[1] < 1e6 else
         f'{k[0]:,.0f} particles, {k[1] / 1e6:g} MPa, ν {k[2]:g}')
    panes[0].set(xscale='log', yscale='log', xlabel='wall time per frame, median [ms]', ylabel='solver error, rms of the tip [%]')
    panes[0].set_xticks([2, 5, 10, 20, 50])
    panes[0].set_xticklabels(['2', '5', '10', '20', '50'])
    panes[0].minorticks_off()
    panes[0].set_title('1 to 8 Newton iterations at most', fontsize=9)
    deadline(panes[0])
    panes[0].legend(frameon=False, fontsize=6, loc='center left', bbox_to_anchor=(1.0, 0.5))
    if not stiff:
        save(figure, folder, 'solver_error', header)
        return
    draw(panes[1], by(stiff, lambda r: r['poisson_ratio']), 'youngs_modulus_pa', 'error_solver', lambda k: f'ν {k:g}')
    panes[1].set(xscale='log', yscale='log', xlabel="Young's modulus [Pa]", ylabel='solver error, rms of the tip [%]')
    panes[1].set_title('default solver, 1,519 particles', fontsize=9)
    panes[1].legend(frameon=False)
    figure.tight_layout()
    save(figure, folder, 'solver_error', header)


def swing(rows, folder, header):
    rows = [r for r in rows if r['problem'] == 'swing']
    figure, panes = plt.subplots(1, 2, figsize=(9, 3.4), sharex=True)
    groups = by(rows, lambda r: (r['solver'], r['particles']))
    for axes, column, title in zip(panes, ('error_discretisation', 'error_field'), ('period', 'second trough')):
        for r in rows:
            r['time_step_ms'] = 1000 * r['time_step_s']
        draw(axes, groups, 'time_step_ms', column, lambda k: f"{k[0].replace('_', ' ')}, {k[1]:.0f} particles")
        axes.set(xscale='log', yscale='log', xlabel='time step [ms]', ylabel='error [%]')
        axes.set_title(title, fontsize=9)
        axes.minorticks_off()
        axes.set_xticks(sorted({r['time_step_ms'] for r in rows}))
        axes.set_xticklabels([f'{t:.3g}' for t in sorted({r['time_step_ms'] for r in rows})])
    panes[0].legend(frameon=False)
    figure.tight_layout()
    save(figure, folder, 'swing', header)


def cut_frames(rows, folder, header):
    """Time of the frames that cut by stage: medians as bars, the 99th percentile of the whole as a mark."""
    rows = sorted((r for r in rows if r['problem'].startswith('cut_') and not r['failed']), key=lambda r: (r['problem'], r['particles']))
    figure, axes = plt.subplots(figsize=(6.4, 3.4))
    for n, row in enumerate(rows):
        times = {stage: [float(v) for v in re.search(stage + r' p50 (\S+) p99 (\S+) max ([^;\s]+)', row['note']).groups()]
                 for stage in (*STAGES, 'total')}
        low = 0
        for stage, colour in zip(STAGES, ('#4477aa', '#ee6677', '#228833', '#ccbb44')):
            axes.bar(n, times[stage][0], 0.55, low, color=colour, label=stage if n == 0 else None)
            low += times[stage][0]
        axes.vlines(n, low, times['total'][1], color='0.2', linewidth=1)
        axes.plot(n, times['total'][1], '_', color='0.2', markersize=16, label='whole, 99th percentile' if n == 0 else None)
    axes.axhline(DEADLINE_MS, color='0.35', linestyle='--', linewidth=1)
    axes.annotate('16.7 ms', (1.01, DEADLINE_MS), xycoords=axes.get_yaxis_transform(), fontsize=7.5, color='0.35', ha='left', va='center')
    axes.set(xlabel='particles', ylabel='wall time of a frame that cuts [ms]', xticks=range(len(rows)))
    axes.set_ylim(0, None)
    axes.set_xticklabels([f"{r['problem'][4:]}\n{r['particles']:,.0f}" for r in rows])
    axes.grid(axis='x', visible=False)
    handles, labels = axes.get_legend_handles_labels()
    order = [labels.index('whole, 99th percentile')] + [labels.index(stage) for stage in reversed(STAGES)]  # as they are stacked
    axes.legend([handles[i] for i in order], [labels[i] + (', median' if labels[i] in STAGES else '') for i in order],
                frameon=False, loc='center left', bbox_to_anchor=(1.09, 0.5))
    save(figure, folder, 'cut_frames', header)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else source.parent
    folder.mkdir(parents=True, exist_ok=True)
    header, rows = read(source)
    figures = {'error_against_time': (error_against_time, any(True for _ in base_case(rows))),
               'convergence': (convergence, any(True for _ in base_case(rows))),
               'solver_error': (solver_error, any(r['error_solver'] > 0 for r in rows)),
               'cut_frames': (cut_frames, any(r['problem'].startswith('cut_') and not r['failed'] for r in rows)),
               'swing': (swing, any(r['problem'] == 'swing' for r in rows))}
    for name, (make, has_rows) in figures.items():
        if has_rows:
            make(rows, folder, header)
            print(folder / f'{name}.svg')


if __name__ == '__main__':
    main()
