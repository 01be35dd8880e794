"""5.3: sequential function charts. SET, OUT and RST of a step stand with the other coils in `contacts.py`."""

from .define import emitted


@emitted("STL", "S:STEP", steps=3, section="5.3.1", bus=True)
def stl(code, step):
    """Begin a step: what follows is executed while it is active, and cleared in the first scan after it has been left."""
    code.step()


@emitted("RET", "", steps=1, section="5.3.5", bus=True)
def ret(code):
    """End a section of steps."""
    code.close()
