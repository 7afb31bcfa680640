"""Reads a unit's terminals as a host does: the file against the schema of FMI 3.0 that FMPy has, its members against the unit's variables.

    python terminals_check.py UNIT.fmu

Prints how many terminals there are, or what is wrong.
"""

import sys
import zipfile
from pathlib import Path

import fmpy
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from lxml import etree

FILE = "terminalsAndIcons/terminalsAndIcons.xml"
SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"

if __name__ == "__main__":
    (unit,) = sys.argv[1:]
    problems = validate_fmu(unit)
    terminals = []
    with zipfile.ZipFile(unit) as archive:
        if FILE in archive.namelist():
            document = etree.fromstring(archive.read(FILE))
            schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
            if not schema.validate(document):
                problems += [str(error) for error in schema.error_log]
            terminals = document.findall("Terminals/Terminal")
    names = [terminal.get("name") for terminal in terminals]
    if len(set(names)) < len(names):
        problems.append(f"terminals of one name: {names}")
    variables = {variable.name for variable in read_model_description(unit).modelVariables}
    for terminal in document.iter("Terminal") if terminals else []:
        variables_of = terminal.findall("TerminalMemberVariable")
        members = [member.get("memberName") for member in variables_of]
        if None in members or len(set(members)) < len(members):
            problems.append(f"members of one name: {members}")
        problems += [f"no variable {member.get('variableName')}" for member in variables_of if member.get("variableName") not in variables]
    print("\n".join(problems) if problems else f"{len(terminals)} terminals")
