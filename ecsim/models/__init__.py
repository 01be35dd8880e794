"""The models by name."""

from ..errors import EcsimError
from .ec import EC10, EC20
from .fx import H1U, H2U
from .model import Area, By, ModbusRange, Model

MODELS = {model.name: model for model in (EC10, EC20, H1U, H2U)}


def get_model(name: "str | Model") -> Model:
    """The model of that name, in any case; a Model is handed through."""
    if isinstance(name, Model):
        return name
    model = MODELS.get(str(name).upper())
    if model is None:
        raise EcsimError(f"there is no model {name!r}; ecsim knows {', '.join(MODELS)}")
    return model


def model_in(name: str) -> str | None:
    """The model that a file's name tells before its ending: answer.h2u.il is a program for H2U; None for a name that tells none."""
    _, *parts = name.removesuffix(".il").split(".")
    return next((part.upper() for part in parts[-1:] if part.upper() in MODELS), None)


__all__ = ["MODELS", "Area", "By", "ModbusRange", "Model", "get_model", "model_in"]
