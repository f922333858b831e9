"""What exported code has around the functions of the kernels: limits, the eight branches, and what is kept of them."""

from string import Template

C = Template("""/* All configurations of $name for a pose. Written by pin-metaik export.
 *
 * To be compiled as C99, with -lm.
 * Joints: $joints.
 */
#include <math.h>

$structures

static const double LOWER[6] = {$lower};
static const double UPPER[6] = {$upper};
static const int COLUMN[6] = {$columns}; /* the joint's place in a configuration, from the base on */

static T2 cos_sin(double x)
{
    return (T2){{cos(x), sin(x)}};
}

static T3 vector(T3 v)
{
    return v;
}

$functions

static int same(const double a[6], const double b[6])
{
    for (int c = 0; c < 6; c++) {
        double d = a[c] - b[c];
        d -= 6.283185307179586 * nearbyint(d / 6.283185307179586);
        if (fabs(d) > 1e-2) {
            return 0;
        }
    }
    return 1;
}

/* Writes all configurations, in rad, into the rows of x, and returns how many there are.
 *
 * target: the pose of the tip in the world, its rotation row by row, then its position in m.
 * near:   a configuration; of copies by whole turns the nearest to it are written, its own branch first.
 */
int arm_solve(const double target[12], const double near[6], double x[8][6])
{
    int count = 0;
    T12 pose;
    T6 guess;
    for (int k = 0; k < 12; k++) {
        pose.v[k] = target[k];
    }
    for (int s = 0; s < 6; s++) {
        guess.v[s] = near[COLUMN[s]];
    }
    for (long number = 0; number < 8; number++) {
        S_T6_int found = branch(pose, guess, number);
        int good = found.m1 && miss(pose, found.m0) <= 1e-10;
        for (int s = 0; s < 6 && good; s++) {
            int c = COLUMN[s];
            double value = nearest_turn(found.m0.v[s], near[c], LOWER[c] - $outside, UPPER[c] + $outside);
            good = LOWER[c] - $outside <= value && value <= UPPER[c] + $outside;
            x[count][c] = fmin(fmax(value, LOWER[c]), UPPER[c]);
        }
        for (int k = 0; k < count && good; k++) {
            good = !same(x[k], x[count]);
        }
        count += good;
    }
    return count;
}
""")

PYTHON = Template('''"""All configurations of $name for a pose. Written by pin-metaik export.

Joints: $joints.
"""

import math

LOWER = $lower
UPPER = $upper
COLUMN = $columns  # the joint's place in a configuration, from the base on


def cos_sin(x):
    return math.cos(x), math.sin(x)


def _whole(x):
    return float(round(x))


def _ceil(x):
    return float(math.ceil(x))


def _floor(x):
    return float(math.floor(x))


$functions


def _same(a, b):
    ways = [p - q for p, q in zip(a, b)]
    return all(abs(way - math.tau * round(way / math.tau)) <= 1e-2 for way in ways)


def solve(target, near=(0.0,) * 6):
    """All configurations, lists of six angles in rad.

    ``target`` is the pose of the tip in the world, twelve numbers: its rotation row by row, then its position in m. Of
    copies by whole turns those nearest to ``near`` are given, its own branch first.
    """
    found = []
    for number in range(8):
        angles, good = branch(tuple(target), tuple(near[c] for c in COLUMN), number)
        if not good or miss(tuple(target), angles) > 1e-10:
            continue
        x = [0.0] * 6
        for value, c in zip(angles, COLUMN):
            value = nearest_turn(value, near[c], LOWER[c] - $outside, UPPER[c] + $outside)
            good = good and LOWER[c] - $outside <= value <= UPPER[c] + $outside
            x[c] = min(max(value, LOWER[c]), UPPER[c])
        if good and not any(_same(x, other) for other in found):
            found.append(x)
    return found
''')
