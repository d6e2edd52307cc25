"""What a user can mend."""


class InputError(Exception):
    """Bad input: one line that names what is wrong, where, and what would be right."""

    def __init__(self, text: str) -> None:
        """Line breaks and other characters that cannot be printed, in names for instance, are shown
        by their codes."""
        super().__init__("".join(c if c.isprintable() else repr(c)[1:-1] for c in text))
