"""FNC 51, 53 to 59 and 155 to 159 of H1U and H2U: pulses in and out, and positioning. All but REFF work as in 6.10 and 6.17.

Of numbers with 16 bits there is a form of its own; the 32-bit forms take pairs, the low word in the lower register.
"""

from ..errors import OPERAND, RAMP, SERVO_CHECKSUM, SERVO_SILENT
from .define import FX, H2U, command
from .highspeed import dhsci, dhscr, dhscs, dhsz, plsr, plsy, spd
from .positioning import drva, drvi, plsv, read_position, zrn

_COUNTED = {"released": True, "faults": (OPERAND,), "models": FX}
_MOVES = {"faults": (OPERAND,), "models": FX}


@command("FX:REFF", "N:INT[const]=0..60", steps=3, section="FNC 51", models=H2U)
def reff(machine, milliseconds):
    """Set the filter of the inputs X0 to X7 to N ms and take these inputs into the program at once."""
    machine.inputs.set_filter(1000 * milliseconds)
    machine.inputs.refresh(machine.clock[0], range(8))


_COMPARED = {"released": True, "models": FX}
command("FX:DHSCS", "claim S1:DINT S2:HCOUNTER >D:POINT[Y M S]", steps=13, section="FNC 53", **_COMPARED)(dhscs)
command("FX:DHSCS I", "claim S1:DINT S2:HCOUNTER D:EVENT", steps=13, section="FNC 53", **_COMPARED)(dhsci)
command("FX:DHSCR", "claim S1:DINT S2:HCOUNTER >D:POINT[Y M S]", steps=13, section="FNC 54", **_COMPARED)(dhscr)
command(
    "FX:DHSZ", "claim S1:DINT S2:DINT S:HCOUNTER >D:POINT[Y M S]*3", steps=17, section="FNC 55", released=True, models=H2U
)(dhsz)  # fmt: skip
command(
    "FX:SPD", "claim S1:POINT[X]=0..5 S2:WORD >D:PLACE[T C D]*3", steps=7, section="FNC 56",
    occupies=lambda model, operands: (operands[0].number,), **_COUNTED,
)(spd)  # fmt: skip
command("FX:PLSY", "claim S1:INT S2:INT >D:PULSE", steps=7, section="FNC 57", **_COUNTED)(plsy)
command("FX:DPLSY", "claim S1:DINT S2:DINT >D:PULSE", steps=13, section="FNC 57", **_COUNTED)(plsy)

_RAMPED = {**_COUNTED, "faults": (OPERAND, RAMP)}
command("FX:PLSR", "claim S1:INT S2:INT S3:INT >D:PULSE", steps=9, section="FNC 59", **_RAMPED)(plsr)
command("FX:DPLSR", "claim S1:DINT S2:DINT S3:DINT >D:PULSE", steps=17, section="FNC 59", **_RAMPED)(plsr)

command(
    "FX:DABS", "claim S:POINT[X Y M S]*3 >D1:POINT*3 >D2:DPLACE[KnY KnM KnS D C]~", steps=13, section="FNC 155",
    faults=(SERVO_SILENT, SERVO_CHECKSUM), models=FX,
)(read_position)  # fmt: skip
for _wide, _type, _more in (("", "INT", 0), ("D", "DINT", 8)):
    command(f"FX:{_wide}ZRN", f"claim S1:{_type} S2:{_type} S3:POINT[X Y M S] >D:PULSE", steps=9 + _more, section="FNC 156", **_MOVES)(zrn)
    command(f"FX:{_wide}PLSV", f"claim S:{_type} >D1:PULSE >D2:POINT", steps=9 + _more, section="FNC 157", **_MOVES)(plsv)
    command(f"FX:{_wide}DRVI", f"claim S1:{_type} S2:{_type} >D1:PULSE >D2:POINT", steps=9 + _more, section="FNC 158", **_MOVES)(drvi)
    command(f"FX:{_wide}DRVA", f"claim S1:{_type} S2:{_type} >D1:PULSE >D2:POINT", steps=9 + _more, section="FNC 159", **_MOVES)(drva)
