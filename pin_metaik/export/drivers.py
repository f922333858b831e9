"""What exported code has around the functions of the kernels: what is called; in Python, its branches, too."""

from string import Template

C = Template("""/* All configurations of $name for a pose. Written by pin-metaik export.
 *
 * To be compiled as C99, with -lm. It writes to no memory but the caller's and its own stack.
 * Joints, as they stand in a configuration: $joints.
 */
$program

$tables

/* Writes configurations, in rad or m, into the rows of x, the nearest to near first, and returns how many there are.
 *
 * target: the pose of the tip in the world, its rotation row by row, then its position in m.
 * near:   a configuration; of copies by whole turns the nearest to it are written.
 * x:      room for most configurations; more than $bound have only poses whose configurations are curves.
 */
int arm_solve(const double target[12], const double near[6], double x[][6], int most)
{
    $arm_type arm = {$arm};
    Wanted wanted = {$limits, near};
    return (int)$function(arm, wanted, target, &x[0][0], most);
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
