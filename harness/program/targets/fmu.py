"""A scene's model as an FMI 3.0 unit for model exchange, with its C sources.

Controls with their time derivatives and second time derivatives are inputs, which start at the values of the control
law. Open parameters are tunable, but fixed if constraints contain them. Coordinates and velocities are states, whose
initial values are near: the unit projects them onto the constraints. They, accelerations, multipliers and the scene's
outputs are outputs.
"""

import hashlib
import io
import platform
import zipfile
from collections.abc import Iterator
from xml.etree import ElementTree

from ...failures import ErrorKind, HolonomError
from ...hidden import visible
from ...language import translatable
from ...temporary import private_directory
from ..c_function import compile_shared
from ..c_source import range_of
from ..model import Model
from ..motion_program import names_used
from ..templates import filled, template
from . import c

XML = "<?xml version='1.0' encoding='utf-8'?>\n"
OPTIONS = ("-std=c11", "-O2", "-fvisibility=hidden", "-shared", "-fPIC")
SUFFIXES = {"linux": ".so", "darwin": ".dylib", "windows": ".dll"}
MACHINES = {"amd64": "x86_64", "arm64": "aarch64"}
EPOCH = (1980, 1, 1, 0, 0, 0)  # of every file in the archive: the same unit is the same bytes


def write_model(model: Model, name: str) -> bytes:
    """Write a model as an FMI 3.0 unit.

    Parameters
    ----------
    model : Model
    name : str
        Name of the model, an identifier of C.

    Returns
    -------
    bytes
        A ZIP archive with modelDescription.xml, the binary for this machine, and the sources.

    Raises
    ------
    HolonomError
        There is no C compiler, the name is not an identifier, or a quantity has no initial value.
    """
    _require_start(model)
    library = c.write_model(model, name)
    sources = {f"{name}.c": library[f"{name}.c"], f"{name}.h": library[f"{name}.h"]}
    sources["fmi3.c"] = template("fmi3.c")
    token = hashlib.sha256("".join(sources.values()).encode()).hexdigest()
    sources["model.h"] = filled("model.h", name=name, NAME=name.upper(), token=token)
    folder, suffix = _platform_folder()
    return _archive(
        {
            "modelDescription.xml": _xml(_model_description(model, name, token)),
            f"binaries/{folder}/{name}{suffix}": _compiled(sources, name),
            "sources/buildDescription.xml": _xml(_build_description(name)),
            **{f"sources/{file}": text.encode() for file, text in sources.items()},
        }
    )


def _platform_folder() -> tuple[str, str]:
    """Return the folder of the binary for this machine, and the binary's suffix."""
    system, machine = platform.system().lower(), platform.machine().lower()
    return f"{MACHINES.get(machine, machine)}-{system}", SUFFIXES.get(system, ".so")


def _model_description(model: Model, name: str, token: str) -> ElementTree.Element:
    """Return modelDescription.xml, with the value references of fmi3.c."""
    root = ElementTree.Element(
        "fmiModelDescription",
        fmiVersion="3.0",
        modelName=model.title,
        description=f"{model.system.title}; {range_of(model.motion)}",
        instantiationToken=token,
        generationTool="Holonom",
        variableNamingConvention="flat",
    )
    ElementTree.SubElement(root, "ModelExchange", modelIdentifier=name, canGetAndSetFMUState="true")
    end = {} if model.law_span is None else {"stopTime": model.law_span[1]}
    ElementTree.SubElement(root, "DefaultExperiment", startTime=model.start["t"], **end)
    variables = ElementTree.SubElement(root, "ModelVariables")
    for reference, attributes in enumerate(_variables(model)):
        ElementTree.SubElement(variables, "Float64", valueReference=str(reference), **attributes)
    structure = ElementTree.SubElement(root, "ModelStructure")
    by_role: dict[str, list[str]] = {"Output": [], "ContinuousStateDerivative": [], "InitialUnknown": []}
    for variable in variables:
        reference = variable.attrib["valueReference"]
        if variable.get("causality") == "output":
            by_role["Output"].append(reference)
        if "derivative" in variable.attrib:
            by_role["ContinuousStateDerivative"].append(reference)
        if variable.get("initial") in ("calculated", "approx"):
            by_role["InitialUnknown"].append(reference)
    for role, references in by_role.items():
        for reference in references:
            ElementTree.SubElement(structure, role, valueReference=reference)
    return root


def _build_description(name: str) -> ElementTree.Element:
    """Return sources/buildDescription.xml, to compile a unit without a binary."""
    root = ElementTree.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=name)
    files = ElementTree.SubElement(configuration, "SourceFileSet", language="C11")
    for file in (f"{name}.c", "fmi3.c"):
        ElementTree.SubElement(files, "SourceFile", name=file)
    return root


def _variables(model: Model) -> Iterator[dict[str, str]]:
    """Attributes of every variable, in the order of the value references."""
    n, velocities = len(model.coordinates), [f"dot({name})" for name in model.coordinates]
    initial, moving = ("approx", names_used(model.constraints)) if model.constraints else ("exact", set())
    named = (*model.coordinates, *model.controls, *model.parameters, *model.observed)
    time = "t" if "time" in named else "time"  # nothing else is named t
    yield {"name": time, "causality": "independent", "variability": "continuous"}
    for state in (*model.coordinates, *velocities):
        yield {"name": state, "causality": "output", "initial": initial, "start": model.start[state]}
    for history, value in zip(model.histories, _inputs_at_start(model), strict=True):
        yield {"name": history, "causality": "input", "start": value}
    for name in model.parameters:
        variability = "fixed" if name in moving else "tunable"
        start = model.values[name]
        yield {"name": name, "causality": "parameter", "variability": variability, "initial": "exact", "start": start}
    for s, name in enumerate((*model.coordinates, *velocities)):
        derivative = {"name": f"der({name})", "causality": "local", "initial": "calculated", "derivative": str(s + 1)}
        yield derivative if s < n else derivative | {"name": f"ddot({model.coordinates[s - n]})", "causality": "output"}
    for name in (*model.multipliers, *model.found, *model.observed):
        yield {"name": name, "causality": "output", "initial": "calculated"}


def _inputs_at_start(model: Model) -> list[str]:
    """Return the initial values of the controls, 0 for a control without a law."""
    values = {}
    if model.law is not None:
        from ..numpy_function import NumpyFunction
        from ..table_numbers import pieces_of_tables

        numbers = [float(model.start["t"]), *(float(model.values[name]) for name in model.parameters)]
        numbers += [float(c) for pieces in pieces_of_tables(model.tables) for c in pieces.at(numbers[0])]
        values = dict(zip(model.law.outputs, NumpyFunction(model.law)(numbers), strict=True))
    return [repr(float(values.get(history, 0))) for history in model.histories]


def _require_start(model: Model) -> None:
    for name in model.parameters:
        if name not in model.values:
            raise HolonomError(ErrorKind.INPUT_MISSING, detail=name)
    if model.start is None:
        raise HolonomError(
            ErrorKind.INPUT_MISSING, detail=translatable("a parameter that the initial state depends on")
        )


def _compiled(sources: dict[str, str], name: str) -> bytes:
    with private_directory() as directory:
        for file, text in sources.items():
            (directory / file).write_text(text, encoding="utf-8")
        library = directory / "library"
        compile_shared([directory / f"{name}.c", directory / "fmi3.c"], library, *OPTIONS)
        return library.read_bytes()


def _xml(root: ElementTree.Element) -> bytes:
    ElementTree.indent(root)
    return (XML + visible(ElementTree.tostring(root, encoding="unicode"))).encode()


def _archive(files: dict[str, bytes]) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, content in files.items():
            archive.writestr(zipfile.ZipInfo(file, EPOCH), content, zipfile.ZIP_DEFLATED)
    return packed.getvalue()
