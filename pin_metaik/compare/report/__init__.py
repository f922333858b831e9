"""Reports: sections of sentences, tables and figures; on the terminal, as Markdown with CSV and figures, as HTML."""

from pin_metaik.compare.report.parts import Column, Figure, Section, Table, Value

__all__ = ["Column", "Figure", "Section", "Table", "Value"]
