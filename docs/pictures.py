"""The pictures that pages and the README show from the repository: drawn by what a reader would call, and compared.

python docs/pictures.py                 # draws all of them into docs/images
python docs/pictures.py shelf.png       # or one
python docs/pictures.py --check         # draws those that need no browser elsewhere: exit code 1 if one is stale

The pictures of the gallery are not among these: they are drawn whenever the site is built.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pinocchio as pin
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
SAME = 0.04  # of the range of brightness, root mean square of the difference of thumbnails
THUMBNAIL = 96, 64  # pixels
WAIT = 1200.0  # s for a browser that draws without a graphics card
FRAME, COLOURS, EACH = (480, 400), 64, 120  # of an animation: pixels of a panel, colours, and ms a frame


def command(*words: object, cwd: Path) -> None:
    """Run ``pin-metaik`` in a folder."""
    subprocess.run(
        [sys.executable, "-m", "pin_metaik", *map(str, words)], cwd=cwd, check=True, stdout=subprocess.DEVNULL
    )


@contextmanager
def looking(address: str) -> Iterator[None]:
    """A chromium without a window that looks at a page."""
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if browser is None:
        raise SystemExit("pictures of worlds need chromium")
    with tempfile.TemporaryDirectory() as profile:
        flags = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            "--enable-unsafe-swiftshader",
        ]
        looks = subprocess.Popen(
            [browser, *flags, f"--user-data-dir={profile}", "--window-size=1440,900", address],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            yield
        finally:
            looks.terminate()
            looks.wait()


def shelf(file: Path) -> None:
    """The shelf in the browser: example 11, with a chromium that looks."""
    example = [sys.executable, "-u", ROOT / "examples" / "11_look_at_the_world.py", "--port", "8991", "--picture", file]
    with subprocess.Popen(example, stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        next(line for line in iter(run.stdout.readline, "") if "HTTP" in line)
        with looking("http://localhost:8991"):
            try:
                run.communicate(timeout=WAIT)
            finally:
                run.terminate()


def along_the_shelf() -> list[pin.SE3]:
    """Poses of a Panda's tool along a line under the high board of the shelf."""
    forward, line = pin.utils.rotate("y", np.pi / 2), np.linspace([0.68, -0.244, 0.682], [0.68, 0.152, 0.62], 25)
    return [pin.SE3(forward, place) for place in line]


def shelf_path(file: Path) -> None:
    """A Panda along a line in the shelf, there and back: the path of ``solve_ik_path`` without the world, and in it."""
    import pin_metaik as mik
    from pin_metaik.collision import load_scene
    from pin_metaik.collision.viewer import open_viewer

    robot = mik.load_robot("panda")
    chain = mik.Chain(robot, robot.frame)
    world = mik.CollisionWorld(robot, load_scene("shelf"))
    poses = along_the_shelf()
    alone, clear = mik.solve_ik_path(chain, poses), mik.solve_ik_path(chain, poses, world=world)
    assert clear.continuous and any(world.in_collision(q) for q in alone.q)
    viewer = open_viewer(world, 0, frame=robot.frame)
    viewer.show_target(poses[-1])
    panels: list[list[Image.Image]] = []
    with looking(f"http://localhost:{viewer.viewer.get_port()}"):
        for path, call in ((alone, "solve_ik_path(chain, poses)"), (clear, "solve_ik_path(chain, poses, world=world)")):
            panels.append([])
            for q in path.q[::2]:
                viewer.display(q)
                panel = Image.fromarray(viewer.picture(*FRAME, timeout=WAIT))
                draw = ImageDraw.Draw(panel)
                draw.text((12, 8), call, fill=(40, 40, 40), font=ImageFont.load_default(16))
                if world.in_collision(q):
                    draw.text((12, 30), "collides", fill=(200, 30, 25), font=ImageFont.load_default(16))
                panels[-1].append(panel)
    viewer.viewer.stop()
    there = [
        Image.fromarray(np.hstack([np.asarray(one), np.asarray(other)])) for one, other in zip(*panels, strict=True)
    ]
    small = [frame.quantize(COLOURS, dither=Image.Dither.NONE) for frame in [*there, *there[-2:0:-1]]]
    shown = json.dumps([path.q[::2].round(6).tolist() for path in (alone, clear)])  # for whoever finds the file
    small[0].save(file, save_all=True, append_images=small[1:], duration=EACH, loop=0, comment=shown, optimize=True)


def printed(*words: object, made: str) -> Callable[[Path], None]:
    """What a command of ``pin-metaik`` draws, as the file ``made`` of its folder."""

    def draw(file: Path) -> None:
        with tempfile.TemporaryDirectory() as folder:
            command(*words, cwd=Path(folder))
            shutil.copy(Path(folder, made), file)

    return draw


def self_motions(file: Path) -> None:
    """The self-motions of a Panda for one pose: in two of its joints, and as ways of its elbow."""
    from matplotlib.figure import Figure

    import pin_metaik as mik

    robot = mik.load_robot("panda")
    chain, elbow = mik.Chain(robot, robot.frame), mik.Chain(robot, "panda_link4")
    q0 = chain.q([0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3])
    motions = mik.self_motions(chain, chain.placements(q0)[0], q0)
    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    joints, places = figure.add_subplot(1, 2, 1), figure.add_subplot(1, 2, 2, projection="3d")
    for number, curve in enumerate(motions):
        Q = curve.sample(0.02)
        x = np.array([chain.x(q) for q in Q])
        joints.plot(*np.rad2deg(x[:, [0, 2]]).T, label=f"curve {number + 1}, {curve.length:.1f} rad")
        places.plot(*np.array([elbow.placements(q)[0].translation for q in Q]).T)
    joints.set(xlabel=f"{chain.names[0]}, deg", ylabel=f"{chain.names[2]}, deg", title="two of its joints")
    joints.legend()
    places.set(xlabel="x, m", ylabel="y, m", zlabel="z, m", title="its elbow")
    places.set_aspect("equal")
    places.locator_params(nbins=4)
    places.set_box_aspect(None, zoom=0.85)
    figure.savefig(file, dpi=110)


def waits(file: Path) -> None:
    """A robot waits before a door: the two files that the page on teaching prints."""
    page = (ROOT / "docs" / "teaching_paths.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("doors.json", "moving.json"):
            content = page.split(f"`{name}`:", 1)[1].split("```json\n", 1)[1].split("```", 1)[0]
            Path(folder, name).write_text(content, encoding="utf-8")
        speed = ("--speed", 1, "--radius", 0.2, "--picture", file)
        command("mobile", "moving", "doors.json", "moving.json", *speed, cwd=Path(folder))


def singular(file: Path) -> None:
    """Orientations of the reference platform at one position, and where det J changes sign."""
    from dataclasses import replace

    from pin_metaik import stewart

    tilt, yaw = np.radians((-30.0, 30.0)), np.radians((-115.0, 115.0))
    spread = stewart.Grid((1, 1, 1), (0, 0), (0, 0), (0.37, 0.37), (21, 21, 41), tuple(tilt), tuple(tilt), tuple(yaw))
    reference = stewart.load_mechanism("reference_6x6")
    mechanism = replace(reference, limits=replace(reference.limits, shortest=0.2, longest=0.6), grid=spread)
    stewart.save_picture(stewart.draw(mechanism, mechanism.survey()), file)


DRAWN: dict[str, Callable[[Path], None]] = {
    "self_motions.png": self_motions,
    "path_generations.png": printed(
        "mobile", "evolve", "ten_obstacles", "--method", "pso", "-o", "it.png", made="it.png"
    ),
    "path_planners.png": printed(
        "mobile", "compare", "ten_obstacles", "--runs", 10, "--out", "together", made="together/planners_paths.png"
    ),
    "path_waits.png": waits,
    "stewart_singular.png": singular,
    "servo_platform.png": printed("stewart", "show", "servo_sg90", "-o", "it.png", made="it.png"),
}
BROWSED: dict[str, Callable[[Path], None]] = {"shelf.png": shelf, "shelf_path.gif": shelf_path}
"""What a browser draws, in minutes; the tests compare the configurations that these files say they show."""


def thumbnail(file: Path) -> np.ndarray:
    """A picture in 96 x 64 pixels, grey, 0 to 1."""
    return np.asarray(Image.open(file).convert("L").resize(THUMBNAIL, Image.Resampling.BOX), dtype=float) / 255.0


def differs(file: Path, other: Path) -> float:
    """How much two pictures differ, as a share of the range of brightness; 1 for other proportions."""
    one, two = Image.open(file).size, Image.open(other).size
    if abs(one[0] / one[1] - two[0] / two[1]) > 0.02:
        return 1.0
    return float(np.sqrt(np.mean((thumbnail(file) - thumbnail(other)) ** 2)))


def main() -> int:
    """Draw, or compare; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help=f"of {', '.join(DRAWN | BROWSED)}; default: all")
    parser.add_argument("--check", action="store_true", help="compare with those that are there, and write none")
    options = parser.parse_args()
    stale = 0
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or (DRAWN if options.check else DRAWN | BROWSED):
            made = Path(folder, name)
            (DRAWN | BROWSED)[name](made)
            kept = IMAGES / name
            if not options.check:
                shutil.copy(made, kept)
                print(kept.relative_to(ROOT))
                continue
            by = differs(made, kept)
            stale += by > SAME
            print(f"{name}: {'stale' if by > SAME else 'as drawn now'}, differs by {by:.3f}")
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
