#!/usr/bin/python3
"""Draws the table of `study`: plot_study.py study.csv [folder]. Writes one SVG and one PNG per figure."""
import collections
import csv
import math
import pathlib
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
    groups = by(base_case(rows), lambda r: r['problem'])
    figure, panes = plt.subplots(1, 2, figsize=(9, 3.6), sharex=True)
    for axes, column, title in zip(panes, ('error_discretisation', 'error_field'),
                                   ('value that the problem is judged by', 'displacement field, relative $L_2$ of samples')):
        draw(axes, groups, 'wall_ms_per_frame_p50', column, lambda k: TITLES.get(k, k))
        axes.set(xscale='log', yscale='log', xlabel='wall time per frame of 1/60 s, median [ms]',
                 ylabel='discretisation error [%]')
        axes.set_title(title, fontsize=9)
        deadline(axes)
    panes[1].legend(loc='center left', bbox_to_anchor=(1.01, 0.5), frameon=False)
    figure.subplots_adjust(wspace=0.28)
    save(figure, folder, 'error_against_time', header)


def convergence(rows, folder, header):
    groups = by(base_case(rows), lambda r: r['problem'])
    figure, axes = plt.subplots(figsize=(5.2, 3.6))
    draw(axes, groups, 'particles', 'error_discretisation', lambda k: TITLES.get(k, k))
    axes.set(xscale='log', yscale='log', xlabel='particles', ylabel='discretisation error [%]')
    axes.legend(loc='center left', bbox_to_anchor=(1.01, 0.5), frameon=False)
    save(figure, folder, 'convergence', header)


def solver_error(rows, folder, header):
    rows = [r for r in rows if r['error_solver'] > 0 or (r['failed'] and r['problem'] == 'cantilever')]
    sweep = [r for r in rows if r['youngs_modulus_pa'] in (1e4, 1e7)]
    stiff = [r for r in rows if r not in sweep]
    figure, panes = plt.subplots(1, 2 if stiff else 1, figsize=(9 if stiff else 5.2, 3.6), squeeze=False)
    panes = panes[0]
    groups = by(sorted(sweep, key=lambda r: (r['youngs_modulus_pa'], r['poisson_ratio'], r['particles'])),
                lambda r: (r['particles'], r['youngs_modulus_pa'], r['poisson_ratio']))
    draw(panes[0], groups, 'wall_ms_per_frame_p50', 'error_solver',
         lambda k: f'{k[0]:.0f} particles, {k[1] / 1000:g} kPa, ν {k[2]:g}')
    panes[0].set(xscale='log', yscale='log', xlabel='wall time per frame, median [ms]', ylabel='solver error, rms of the tip [%]')
    panes[0].set_title('1, 2, 4 Newton iterations at most', fontsize=9)
    deadline(panes[0])
    panes[0].legend(frameon=False, fontsize=6)
    if not stiff:
        save(figure, folder, 'solver_error', header)
        return
    draw(panes[1], by(stiff, lambda r: r['poisson_ratio']), 'youngs_modulus_pa', 'error_solver', lambda k: f'ν {k:g}')
    panes[1].set(xscale='log', yscale='log', xlabel="Young's modulus [Pa]", ylabel='solver error, rms of the tip [%]')
    panes[1].set_title('default solver, 3,321 particles', fontsize=9)
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
               'swing': (swing, any(r['problem'] == 'swing' for r in rows))}
    for name, (make, has_rows) in figures.items():
        if has_rows:
            make(rows, folder, header)
            print(folder / f'{name}.svg')


if __name__ == '__main__':
    main()
