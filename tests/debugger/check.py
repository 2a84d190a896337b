# `gdb -batch -x check.py PROGRAM`, where PROGRAM is main.cpp's: what gdb shows by lightbin_gdb.py, and what Visual
# Studio would show by lightbin.natvis, is what the program prints of its lists. As there is no Visual Studio here, the
# elements of the natvis are read below, and gdb evaluates its expressions.
import os
import re
import tempfile
import xml.etree.ElementTree as xml

import gdb

top = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
views = os.path.join(top, "packaging", "debugger")


def check(what, shown, wanted):
    if shown != wanted:
        print("%s shows\n%s\nwhere it should show\n%s" % (what, "\n".join(shown), "\n".join(wanted)))
        gdb.execute("quit 1")
    print("%s: %d lines are right" % (what, len(shown)))


def evaluate(expression):
    """Evaluates what Microsoft's library and the natvis have names for, with libstdc++'s and gdb's names."""
    expression = expression.replace("_Mydata", "_M_ptr").replace("_Mysize", "_M_extent._M_extent_value")
    return gdb.parse_and_eval(re.sub(r"\b(\w+_)\b", r"grid.\1", re.sub(r"\bcell\b", "$cell", expression)))


def fill_in(text):
    return re.sub(r"{([^}]+)}", lambda place: str(int(evaluate(place[1]))), text)


def natvis_lines(element):
    for child in element:
        kind = child.tag.rpartition("}")[2]
        if kind == "DisplayString":
            yield fill_in(child.text)
        elif kind == "Variable":
            gdb.set_convenience_variable(child.get("Name"), int(child.get("InitialValue")))
        elif kind == "Item":
            pointer, count = re.fullmatch(r"(.*), \[(.*)\]", child.text.strip()).groups()
            first = evaluate(pointer)
            ids = [str(int(first[i])) for i in range(int(evaluate(count)))]
            yield "%s = {%s}" % (fill_in(child.get("Name")), ", ".join(ids))
        elif kind == "Exec":
            evaluate(child.text)
        elif kind == "Loop":
            while evaluate(child.get("Condition")):
                yield from natvis_lines(child)
        elif kind == "If":
            if evaluate(child.get("Condition")):
                yield from natvis_lines(child)
        elif kind in ("Expand", "CustomListItems"):
            yield from natvis_lines(child)
        elif kind != "AlternativeType":
            raise ValueError("this test cannot read " + kind)


def gdb_lines(expression):
    shown = gdb.execute("print " + expression, to_string=True)
    return re.findall(r"Light\w+ of [^=]*(?= =)|\[[0-9, ]+\] = {[0-9, ]+}", shown)


try:
    for setting in "confirm off", "debuginfod enabled off", "print elements 0":
        gdb.execute("set " + setting)
    gdb.execute("source " + os.path.join(views, "lightbin_gdb.py"))
    with tempfile.NamedTemporaryFile("r") as printed:
        gdb.execute("break stop")
        gdb.execute("run >" + printed.name)
        wanted = printed.read().splitlines()
    split = next(i for i, line in enumerate(wanted) if line.startswith("LightMasks"))
    lists, masks = wanted[:split], wanted[split:]

    visualizer = xml.parse(os.path.join(views, "lightbin.natvis")).getroot()[0]
    check("lightbin.natvis", list(natvis_lines(visualizer)), lists)
    names = [visualizer.get("Name")] + [child.get("Name") for child in visualizer if child.get("Name")]
    with open(os.path.join(top, "include", "lightbin", "detail", "base", "abi_tag.hpp")) as header:
        levels = re.findall(r"#define LIGHTBIN_LEVEL (\w+)", header.read().partition("defined(__ARM")[0])
    check("of abi_tag.hpp, lightbin.natvis", sorted(names),
          sorted("lightbin::built_for_%s::LightGrid<*>" % level for level in levels + ["baseline"]))

    check("print masks", gdb_lines("masks"), masks)
    check("print grid", gdb_lines("grid"), lists)
    gdb.execute("up")
    check("print *grid of a Result", gdb_lines("*grid"), lists)
    gdb.execute("kill")
except Exception as error:
    print(error)
    gdb.execute("quit 1")
