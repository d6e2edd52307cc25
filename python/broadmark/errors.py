"""Errors that a user can fix."""


class InputError(ValueError):
    """Bad input. The message is a line that names the file or option, the error and the expected input."""

    def __init__(self, text: str) -> None:
        """Escapes line breaks and other unprintable characters, for example in file names."""
        super().__init__("".join(c if c.isprintable() else repr(c)[1:-1] for c in text))
