"""Reading a robot's file: bytes of any encoding to text, text to a tree as forgivingly as the URDF parser.

TinyXML2, which reads URDF for Pinocchio, takes what strict XML forbids and people's files have: prefixes nobody
declared, blank lines and text before the declaration, ``--`` inside comments, a bare ``&`` or ``<`` in a value, control
characters, elements beside the root. Expat is strict, so it is given the outermost ``<robot>`` alone, escaped, and
without its handling of namespaces.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from xml.parsers import expat

from pin_metaik.errors import InvalidModel
from pin_metaik.files import DEEPEST, read_bytes

_MARKS = {
    b"\xef\xbb\xbf": "utf-8-sig",
    b"\xff\xfe\0\0": "utf-32",
    b"\0\0\xfe\xff": "utf-32",
    b"\xff\xfe": "utf-16",
    b"\xfe\xff": "utf-16",
}
_WIDE = {b"<\0": "utf-16-le", b"\0<": "utf-16-be"}  # UTF-16 without its mark
_POINTER = "version https://git-lfs"
_DECLARED = re.compile(rb"""<\?xml[^>]*encoding\s*=\s*["']([\w.:-]+)["']""")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_AMPERSAND = re.compile(r"&(?!(?:amp|lt|gt|quot|apos|#\d+|#x[0-9a-fA-F]+);)")
_VALUE = re.compile(r"""=\s*(?:"[^"]*"|'[^']*')""")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
_ELEMENT = re.compile(r"<([A-Za-z_][\w.:-]*)")


def read_text(path: Path) -> str:
    """Text of a robot's file, in any encoding that it declares or shows.

    Raises:
        InvalidModel: If there is no such file, it cannot be read, or is not text.
    """
    text, end, _ = decoded(read_bytes(path, InvalidModel)).partition("\0")  # where C's strings end
    if end and not outermost(text):
        raise InvalidModel(f"{path} is not a URDF: it is not text")
    if text.startswith(_POINTER):
        raise InvalidModel(f"{path} is a pointer of Git LFS, not the file it stands for: git lfs pull fetches that")
    return text


def decoded(content: bytes) -> str:
    """Bytes as text: by their mark, else as declared, else UTF-8, else Latin-1, which takes everything."""
    declared = _DECLARED.search(content[:1024])
    guesses = [code for mark, code in _MARKS.items() if content.startswith(mark)]
    guesses += [code for start, code in _WIDE.items() if content.lstrip(b" \t\r\n")[:2] == start]
    guesses += [declared.group(1).decode("ascii")] if declared else []
    for encoding in (*guesses, "utf-8"):
        try:
            text = content.decode(encoding)
        except (UnicodeDecodeError, LookupError):
            continue
        if "<" in text or encoding == "utf-8":  # a wrong declaration of UTF-16 makes other letters, not an error
            return text
    return content.decode("latin-1")


def outermost(text: str) -> str:
    """Name of the first element, empty if there is none."""
    found = _ELEMENT.search(_COMMENT.sub("", text))
    return found.group(1) if found else ""


def parsed(text: str, what: str) -> ET.Element:
    """The outermost ``<robot>`` of a URDF text; prefixes stay in the names, as in ``sensor:camera``.

    Args:
        text: The text.
        what: The file, for messages.

    Raises:
        InvalidModel: If there is no ``<robot>``, or its elements do not close; the message has the line.
    """
    text = _COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), text)
    start = re.search(r"<robot(?![\w.:-])", text)
    if start is None:
        first = outermost(text)
        wrong = f"its outermost element is <{first}>, not <robot>" if first else "it has no XML element <robot>"
        raise InvalidModel(f"{what} is not a URDF: {wrong}")
    end = text.rfind("</robot>")
    body = text[start.start() : end + len("</robot>") if end > 0 else None]
    body = _AMPERSAND.sub("&amp;", _CONTROL.sub("", body))
    body = _VALUE.sub(lambda value: value.group().replace("<", "&lt;"), body)

    builder, deep = ET.TreeBuilder(), 0

    def begin(tag: str, attributes: dict[str, str]) -> None:
        nonlocal deep
        deep += 1
        if deep > DEEPEST:
            raise InvalidModel(f"{what} is not a URDF: elements are nested too deeply")
        builder.start(tag, attributes)

    def end_of(tag: str) -> None:
        nonlocal deep
        deep -= 1
        builder.end(tag)

    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler = begin
    parser.EndElementHandler = end_of
    parser.CharacterDataHandler = builder.data
    try:
        parser.Parse("\n" * text.count("\n", 0, start.start()) + body, True)
    except expat.ExpatError as error:
        raise InvalidModel(f"{what} is not well-formed XML: {error}") from None
    return builder.close()


def mjcf_tree(text: str) -> ET.Element:
    """The elements of an MJCF.

    Raises:
        InvalidModel: If they do not close; the message has the line.
    """
    try:
        return ET.fromstring(text)
    except ET.ParseError as error:
        raise InvalidModel(f"this MJCF is not well-formed XML: {error}") from None


def mjcf_meshes(text: str) -> Iterator[str]:
    """Where the meshes of an MJCF may be, from the folder that it is in."""
    tree = mjcf_tree(text)
    folders = [one.get(key, "") for one in tree.iter("compiler") for key in ("meshdir", "assetdir")]
    for name in (mesh.get("file", "") for mesh in tree.iter("mesh")):
        for folder in {"", *folders}:
            yield from (str(Path(folder, name)), str(Path(folder, Path(name).name)))  # the latter with strippath
