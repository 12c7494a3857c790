"""The exceptions of the package. Messages are those of the program: PLACE: VALUE: expected ..."""


class Error(Exception):
    """Any error that Needlework reports."""


class InputError(Error, ValueError):
    """A scene, an argument or an input file that cannot be used."""


class InvalidStateError(Error):
    """A simulation that cannot go on correctly, such as the collapse of a pair of needles.

    The simulation stays as it was before the event that failed.
    """


class IoError(Error, OSError):
    """A file that cannot be read or written, or that exists already."""
