# SPDX-License-Identifier: GPL-3.0-or-later
"""A number that the user types while dragging."""


class TypedNumber:
    def __init__(self) -> None:
        self.text = ""

    def __bool__(self) -> bool:
        return bool(self.text)

    @property
    def value(self) -> float:
        """The number; 0 until there is a digit."""
        return float(self.text) if any(c.isdigit() for c in self.text) else 0.0

    def take(self, character: str) -> bool:
        """Returns whether the character belongs to a number. A minus sign changes the sign at any
        time.
        """
        if character == "-":
            self.text = (
                self.text.removeprefix("-") if self.text.startswith("-") else f"-{self.text}"
            )
        elif character.isdecimal() or (character == "." and "." not in self.text):
            self.text += character
        else:
            return False
        return True

    def erase(self) -> None:
        self.text = self.text[:-1]
