"""Examples at the end of the help of each command. The tests parse all of them."""

from __future__ import annotations

import typer

EXAMPLES = {
    "solve": (
        "pin-metaik solve ur5 --position 0.3 0.3 0.4 --rpy 0 90 0 --degrees",
        "pin-metaik solve ur5 --position 0.3 0.3 0.4 --world table --plot arm.png",
        "pin-metaik solve panda --position 0.68 -0.25 0.6 --rpy 0 90 0 --degrees --world shelf --show",
        "pin-metaik solve my_arm.urdf --position 0.4 0.1 0.5 --seeder gwo --json",
        "pin-metaik solve ur5 --position 0.3 0.3 0.4 --rpy 0 90 0 --degrees --select nearest --weight elbow_joint=3",
        "pin-metaik solve ur5 --goal 'look_at frame=tool0 point=1,0,0.5'",
    ),
    "robots": ("pin-metaik robots", "pin-metaik robots ur5", "pin-metaik robots --json"),
    "urdf": ("pin-metaik urdf rv7fl -o rv7fl.urdf", "pin-metaik urdf my_table.toml -o my_arm.urdf"),
    "demo": ("pin-metaik demo",),
    "reproduce": ("pin-metaik reproduce puma_offset", "pin-metaik reproduce rv7fl --quick --out out/rv7fl"),
    "compare": (
        "pin-metaik compare --robot ur5 --cases singular --methods lm,lm+restarts,gwo+dls --out out/mine",
        "pin-metaik compare --robot panda ur5 --cases near_limit --methods default --jobs -1 --out out/two",
    ),
    "report": ("pin-metaik report out/mine",),
    "replay": ("pin-metaik replay out/mine ur5/singular/17/gwo+dls/0",),
    "plan": (
        "pin-metaik plan ten_obstacles --method exact",
        "pin-metaik plan random:3 --trajectory dp --paths 3 --out out/plan",
    ),
    "reachability": (
        "pin-metaik reachability ur5 --spacing 0.1 --orientations 20 -o map.parquet -o map.png",
        "pin-metaik reachability panda --world shelf --show",
    ),
    "place-base": ("pin-metaik place-base ur5 poses.csv --places 2000",),
    "toolbox": ("pin-metaik toolbox", "pin-metaik toolbox --port 0 --no-browser"),
    "export": ("pin-metaik export ur5 -o ur5.py", "pin-metaik export my_arm.urdf -o my_arm.c"),
    "warm": ("pin-metaik warm", "pin-metaik warm --robot panda --robot ur5"),
    "mobile show": ("pin-metaik mobile show ten_obstacles -o scene.png",),
    "mobile compare": ("pin-metaik mobile compare ten_obstacles --runs 20 --out out/planners",),
    "mobile evolve": ("pin-metaik mobile evolve ten_obstacles --method pso -o generations.png",),
    "mobile drive": ("pin-metaik mobile drive map.json --from 1 1 90 0.2 5 --to 9 9 0 0.2 --out motion",),
    "mobile curve": (
        "pin-metaik mobile curve --turning-radius 5 --from 0 0 0 --to 0 2 0 --reverse --picture parking.png",
    ),
    "mobile moving": ("pin-metaik mobile moving doors.json moving.json --speed 1 --radius 0.2 --picture waits.png",),
    "mobile learn": ("pin-metaik mobile learn --help",),
    "stewart new": ("pin-metaik stewart new 6x3 --base 200 --platform 90 -o mine.toml",),
    "stewart show": ("pin-metaik stewart show servo_sg90 -o servos.png",),
    "stewart analyse": ("pin-metaik stewart analyse stroke_100 --pose 20 -15 240 5 -8 12",),
    "stewart forward": ("pin-metaik stewart forward reference_6x6 -- 360 361 362 363 364 365",),
    "stewart follow": ("pin-metaik stewart follow reference_6x6 way.csv -o legs.csv --picture legs.png",),
    "stewart design": ("pin-metaik stewart design stroke_100 --algorithm qpso -o mine.toml --history mine.csv",),
    "stewart types": ("pin-metaik stewart types mine.toml --evaluations 600 -o found",),
}
"""Command lines, by the words that name a command."""

KEPT = "\b\n"  # what follows is not wrapped into a paragraph


def show_examples(app: typer.Typer) -> None:
    """Let the help of every command of an app, and of the apps in it, end with its examples."""
    groups = {"": app, **{f"{group.name} ": group.typer_instance for group in app.registered_groups}}
    for prefix, group in groups.items():
        if group is not None:
            for command in group.registered_commands:
                lines = EXAMPLES[f"{prefix}{command.name}"]
                command.epilog = "\n".join([KEPT + "Examples:", *(f"  {line}" for line in lines)])
