"""Numbers of a file, in its units, without losing a bit on the way there and back.

45.1 mm is 0.0451 m: in binary, dividing by 1000 and multiplying again need not give the number one started from. In
decimal it does, and every float has a shortest decimal that reads back as the same float.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Context, Decimal

CONTEXT = Context(prec=50)
PI = Decimal("3.14159265358979323846264338327950288419716939937511")
DIGITS = 20  # 17 tell all floats apart; the factor of a unit may need a few more


@dataclass(frozen=True)
class Unit:
    """A unit a file may use.

    Attributes:
        name: As in the file.
        factor: How much of the package's unit (m, rad) it is.
    """

    name: str
    factor: Decimal

    def read(self, number: Decimal | int) -> float:
        """A number of the file in the package's unit, rounded once."""
        return float(CONTEXT.multiply(Decimal(number), self.factor))

    def write(self, value: float) -> str:
        """The shortest number for the file that reads back as this value."""
        exact = CONTEXT.divide(Decimal(value), self.factor)
        for digits in range(1, DIGITS + 1):
            short = Context(prec=digits).plus(exact)
            if self.read(short) == value:
                return plain(short)
        return plain(exact)


def plain(number: Decimal) -> str:
    """A decimal as TOML has it: no exponent, no zeros at the end, no sign of zero."""
    text = format(number, "f")
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return text if text.strip("-0.") else "0"


LENGTHS = {name: Unit(name, Decimal(factor)) for name, factor in (("m", "1"), ("cm", "0.01"), ("mm", "0.001"))}
ANGLES = {"rad": Unit("rad", Decimal(1)), "deg": Unit("deg", CONTEXT.divide(PI, Decimal(180)))}
PURE = Unit("", Decimal(1))
