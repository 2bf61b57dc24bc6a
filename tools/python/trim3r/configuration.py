# SPDX-License-Identifier: Apache-2.0
"""Settings: a t3r_config of names and numbers."""
from typing import Any, Dict, Mapping, Optional, Union

from ._native import INTERFACE, called, ffi, lib, text_of, value_named
from ._settings import SETTINGS
from .arguments import setting
from .heads import Head
from .image_stage import default_config

Settings = Mapping[str, Union[int, str]]

_NUMBERS = ("number", "q8", "toggle")  # the kinds of settings whose values have no names
_VALUES_MOST = 16
_GAUSSIANS_MOST = 1 << 24


def setting_value(name: str, value: str) -> int:
    """The value of a setting that takes names. Raises ValueError, which lists the names, where there is none."""
    kind = SETTINGS[name][0]
    if kind in _NUMBERS:
        raise ValueError(f"{name} is a number, not {value!r}")
    return value_named(name, getattr(lib, f"t3r_{kind}_name"), _VALUES_MOST, value)


def configuration(width: int, height: int, views: int, gaussians: Optional[int], head: Head,
                  settings: Settings) -> Any:
    """A t3r_config of these settings.

    Raises ValueError where one is out of its range, or there is no such setting.
    """
    if gaussians is None:
        gaussians = min(setting("width", width) * setting("height", height) * max(setting("views", views), 1),
                        _GAUSSIANS_MOST)
    config = default_config(width, height, views, gaussians)
    config.head, config.head_column_bytes = head.value, head.column_bytes(width)
    for name, value in settings.items():
        if name not in SETTINGS:
            raise ValueError(f"there is no setting {name!r}; there are {', '.join(SETTINGS)}")
        if isinstance(value, str):
            value = setting_value(name, value)
        setattr(config, name, setting(name, value))
    called("t3r_plan_bytes_as", INTERFACE, config, ffi.new("size_t *"), ffi.new("size_t *"))
    return config


def preset(name: str) -> Dict[str, Any]:
    """Head and settings for an amount of work, like `--preset` of the program.

    Parameters
    ----------
    name : str
        "fast", "balanced" or "best".

    Returns
    -------
    dict
        The arguments `head` and `settings` of Reconstructor and evaluate(): Reconstructor(256, 256, **preset("fast")).

    Raises
    ------
    ValueError
        There is no such preset.
    """
    value = value_named("a preset", lib.t3r_preset_name, lib.T3R_PRESET_COUNT, name)
    before, after, weights = default_config(8, 8, 1, 1), default_config(8, 8, 1, 1), ffi.new("const char **")
    called("t3r_set_preset_as", INTERFACE, value, after, weights)
    changed = {name: getattr(after, name) for name in SETTINGS
               if getattr(after, name) != getattr(before, name) and name != "head"}
    return {"head": text_of(weights[0]), "settings": changed}
