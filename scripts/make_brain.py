#!/usr/bin/python3
"""Writes meshes/brain.obj: the left hemisphere of a human cerebrum with open sulci, from a magnetic resonance image.

Needed only to make the mesh anew, never to build, test or run the package:

    apt-get install mricron-data python3-nibabel python3-skimage python3-scipy python3-numpy
    scripts/make_brain.py [--volume /usr/share/mricron/templates/ch2bet.nii.gz] [--output meshes/brain.obj]

The volume is ch2bet of MRIcron (BSD-3-Clause): a T1 image of one head, 27 times averaged, skull removed, voxels of 1 mm,
axes right, front, up (Holmes et al. 1998, "Enhancement of MR images using registration for signal averaging").
The mesh is closed and in metres; x to the patient's left, y to the back, z up (right-handed, as in liver.obj), its
bounding box centred at 0. Nothing is random: the same volume and libraries give the same bytes.
"""

import argparse
import os

import nibabel
import numpy as np
from scipy import ndimage
from skimage import measure, segmentation

# Intensities of this volume: fluid about 35, grey matter 84, white matter 111.
TISSUE = 66.0
# A sulcus is often narrower than a voxel and shows as a dark line only, not as fluid. What a voxel lacks to the closed
# image (grey closing over 5 mm) is taken off again this many times, so that dark lines become gaps.
GROOVE_GAIN = 1.0
SMOOTHING_MM = 0.7  # standard deviation; more closes the narrow grooves
SAMPLING_MM = 2.2  # of the marching cubes: sets the size of the file
# Seeds of the watershed that parts cerebrum, and cerebellum with brain stem: boxes in mm, axes of the volume.
CEREBRUM_SEEDS = [((-60, -80, 20), (60, 50, 60)), ((-65, -60, -2), (65, 50, 25)), ((-60, -20, -40), (-25, 15, -10)),
                  ((25, -20, -40), (60, 15, -10)), ((-40, -100, 2), (40, -70, 20)), ((-64, -45, -18), (-50, -15, 0))]
CEREBELLUM_SEEDS = [((-40, -80, -60), (40, -50, -36)), ((-8, -65, -40), (8, -45, -12)), ((-12, -38, -71), (12, -15, -24))]
BRAIN_STEM_TOP_MM = -14.0  # nothing parts midbrain from cerebrum: cut off level


def longitudinal_fissure(image, origin):
    """x of the middle of the head, mm, for each (y, z) of the volume: the darkest place within 6 mm of x = 0, weighted by
    how dark it is and smoothed over 12 mm, so that it follows the falx where there is fluid and bridges the rest."""
    x = np.arange(-6, 7)
    slab = ndimage.gaussian_filter(image, 0.7)[x - int(origin[0])]
    darkness = np.clip(80 - slab, 0, None) ** 2 * (slab > 5)
    total = ndimage.gaussian_filter(darkness.sum(axis=0), 12)
    moment = ndimage.gaussian_filter((darkness * x[:, None, None]).sum(axis=0), 12)
    return moment / (total + 20)  # the constant draws it to x = 0 where there is nothing to see


def cerebrum(image, origin):
    """Voxels of the cerebrum: watershed of the dark lines (tentorium) between the seeds."""
    seeds = np.zeros(image.shape, dtype=np.int32)
    for label, boxes in ((1, CEREBRUM_SEEDS), (2, CEREBELLUM_SEEDS)):
        for low, high in boxes:
            region = tuple(slice(int(a - o), int(b - o) + 1) for a, b, o in zip(low, high, origin))
            seeds[region] = label
    seeds[image < TISSUE] = 0
    relief = -ndimage.gaussian_filter(image, 1.0)
    label = segmentation.watershed(relief, seeds, mask=image > 20)
    return label == 1


def hemisphere_field(image, origin):
    """Smooth scalar field over the volume, above 0 in the tissue of the left cerebral hemisphere."""
    grooves = ndimage.grey_closing(image, size=(5, 5, 5)) - image
    field = image - GROOVE_GAIN * grooves - TISSUE
    x, y, z = (np.arange(n) + o for n, o in zip(image.shape, origin))
    fissure = longitudinal_fissure(image, origin)
    # Both hemispheres touch at the falx: the left one ends half a millimetre before it. Corpus callosum, thalamus and
    # midbrain are cut through there: the flat part of the medial side.
    left = np.clip((fissure[None] - 0.5 - x[:, None, None]) * 20, -40, 40)
    stem = np.clip((z - BRAIN_STEM_TOP_MM) * 20, -40, 40)[None, None, :]
    stem_column = (np.abs(x) < 22)[:, None, None] & ((y > -45) & (y < 0))[None, :, None]
    field = np.minimum(np.minimum(field, left), np.where(stem_column, stem, 40))
    field = np.where(cerebrum(image, origin), np.clip(field, -40, 40), np.minimum(field, -20))
    field = ndimage.gaussian_filter(field, SMOOTHING_MM)
    # Crumbs (vessels, meninges) go; cavities closed on all sides are filled.
    labels, _ = ndimage.label(field > 0)
    largest = np.argmax(np.bincount(labels.ravel())[1:]) + 1
    field = np.where((field > 0) & (labels != largest), -1.0, field)
    solid = ndimage.binary_fill_holes(labels == largest)
    return np.where(solid & (field <= 0), 1.0, field)


def surface(field, origin):
    """Closed surface of field > 0: vertices (n, 3), mm, axes of the volume, and triangles (m, 3)."""
    steps = [np.arange(-2, n + 1, SAMPLING_MM) for n in field.shape]
    samples = ndimage.map_coordinates(field, np.meshgrid(*steps, indexing='ij'), order=1, mode='constant', cval=-20)
    # What sampling broke off goes as well.
    labels, _ = ndimage.label(samples > 0)
    largest = np.argmax(np.bincount(labels.ravel())[1:]) + 1
    samples[(samples > 0) & (labels != largest)] = -0.5
    labels, _ = ndimage.label(samples <= 0, structure=np.ones((3, 3, 3)))
    samples[(samples <= 0) & (labels != labels[0, 0, 0])] = 0.5
    # Away from 0, so that no two vertices round to the same place.
    samples = np.where(samples > 0, np.maximum(samples, 0.5), np.minimum(samples, -0.5))
    vertices, triangles, _, _ = measure.marching_cubes(samples, 0.0, gradient_direction='ascent')
    return vertices * SAMPLING_MM - 2 + np.asarray(origin), triangles


HEAD = """\
# left hemisphere of a human cerebrum; x left, y back, z up; metres; written by scripts/make_brain.py
# Derived from ch2bet.nii.gz of MRIcron, Copyright 2006-2010 Chris Rorden, BSD-3-Clause: see meshes/README.md
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    meshes = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'meshes')
    parser.add_argument('--volume', default='/usr/share/mricron/templates/ch2bet.nii.gz')
    parser.add_argument('--output', default=os.path.normpath(os.path.join(meshes, 'brain.obj')))
    arguments = parser.parse_args()

    volume = nibabel.load(arguments.volume)
    if not np.array_equal(volume.affine[:3, :3], np.eye(3)):
        parser.error(f'{arguments.volume}: voxels of 1 mm, axes right, front, up are expected')
    origin = volume.affine[:3, 3]
    image = np.asarray(volume.dataobj, dtype=float)
    vertices, triangles = surface(hemisphere_field(image, origin), origin)
    vertices = vertices * [-0.001, -0.001, 0.001]
    vertices -= (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    vertices = np.round(vertices, 5) + 0.0
    with open(arguments.output, 'w', encoding='ascii', newline='\n') as out:
        out.write(HEAD)
        out.writelines('v {:g} {:g} {:g}\n'.format(*v) for v in vertices)
        out.writelines('f {} {} {}\n'.format(*t) for t in triangles + 1)
    print(f'{arguments.output}: {len(vertices)} vertices, {len(triangles)} triangles')


if __name__ == '__main__':
    main()
