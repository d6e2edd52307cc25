"""What a user can mend."""


class InputError(Exception):
    """Bad input: one line that names what is wrong, where, and what would be right."""
