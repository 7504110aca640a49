"""Fragility curves as NRML 0.5, the XML that OpenQuake reads."""

from __future__ import annotations

from xml.etree import ElementTree

from rocking_cli.studies.fragility.openquake import OpenQuakeModel, identifier
from rocking_cli.text import one_line

NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"


def nrml(model: OpenQuakeModel, name: str, description: str) -> bytes:
    """Return an NRML document with the curves of a model.

    Parameters
    ----------
    model : OpenQuakeModel
        The curves.
    name : str
        Name of the study.
    description : str
        Description of the model in a sentence; characters that are not ASCII become question marks.
    """
    root = ElementTree.Element("nrml", {"xmlns": NAMESPACE})
    about = {"id": identifier(name), "assetCategory": "buildings", "lossCategory": "structural"}
    whole = ElementTree.SubElement(root, "fragilityModel", about)
    ElementTree.SubElement(whole, "description").text = one_line(description).encode("ascii", "replace").decode()
    ElementTree.SubElement(whole, "limitStates").text = " ".join(model.limits)
    for each in model.functions:
        kind = {"id": each.name, "format": "continuous", "shape": "logncdf"}
        function = ElementTree.SubElement(whole, "fragilityFunction", kind)
        least, most = map(repr, each.ends)
        ends = {"imt": each.intensity_type, "noDamageLimit": repr(each.without_damage), "minIML": least, "maxIML": most}
        ElementTree.SubElement(function, "imls", ends)
        for limit, (mean, deviation) in zip(model.limits, each.parameters, strict=True):
            parameters = {"ls": limit, "mean": repr(mean), "stddev": repr(deviation)}
            ElementTree.SubElement(function, "params", parameters)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"
