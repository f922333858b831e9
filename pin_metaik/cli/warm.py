"""``pin-metaik warm``: compile every loop ahead of use, for a container or before a demonstration."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from pin_metaik.cli.options import Json
from pin_metaik.cli.versions import print_json
from pin_metaik.collision import CollisionWorld
from pin_metaik.notice import notice
from pin_metaik.robots import load_robot


def warm(
    robot: Annotated[list[str] | None, typer.Option(help="Robots whose meshes are simplified as well.")] = None,
    as_json: Json = False,
) -> None:
    """Compile all loops ahead of use, and report the time; those compiled earlier are skipped."""
    from pin_metaik.compiled import ahead

    robots = [load_robot(name) for name in robot or ()]
    began = time.perf_counter()
    loops, missing = ahead.versions()
    todo = [loop for loop in loops if not loop.ready]
    folder = ahead.folder_for(todo)
    if todo:
        with notice(f"compiling {len(todo)} loops, kept in {folder}", len(todo)) as line:
            for _ in ahead.each(ahead.Version.compile, todo):
                line.step()
    seconds = {"loops": time.perf_counter() - began}
    for each in robots:
        began = time.perf_counter()
        CollisionWorld(each).checker  # noqa: B018  # made when first looked at
        seconds[each.name] = time.perf_counter() - began
    if as_json:
        done = {"loops": len(loops), "compiled": len(todo), "folder": str(folder), "left_out": list(missing)}
        print_json({**done, "seconds": seconds})
        return
    spent = seconds.pop("loops")
    print(
        f"compiled {len(todo)} of {len(loops)} loops in {spent:.1f} s, stored in {folder}"
        if todo
        else f"all {len(loops)} loops are there"
    )
    for why in missing:
        print(f"left out: {why}")
    for name, took in seconds.items():
        print(f"meshes of {name}: {took:.1f} s")
