"""Wrong records: one thing changed at a time, by classes. Nothing of the package is used here.

A class takes a record, which it may change, and a random generator; it returns the changed record, or None where the
record has nothing of the kind. Whether the change is a real one is for the evaluator to show.
"""

import copy
import json

CLASSES = {}
ALGEBRA = set()
CLOSED = {"4", "5", "8", "9", "10", "11"}


def of_class(name, algebra=False):
    def noted(function):
        CLASSES[name] = function
        if algebra:
            ALGEBRA.add(name)
        return function

    return noted


def mutant(name, record, draw):
    """A record of that class, made of a true one; None where there is none."""
    return CLASSES[name](copy.deepcopy(record), draw)


# ---- parts of a record ----


def parts(record):
    return [*record["derivations"], *record["scenes"]]


def equations(record):
    return [equation for part in parts(record) for equation in part["equations"]]


def relations(record):
    return [relation for equation in equations(record) for relation in equation["relations"]]


def named(record, wanted):
    return [equation for equation in equations(record) if equation["id"] == wanted]


def nodes(tree, path=()):
    """All parts of a tree that are expressions, with their paths."""
    yield path, tree
    if isinstance(tree, list) and tree[0] not in ("Subscript", "Rational"):
        for i, part in enumerate(tree[1:], 1):
            yield from nodes(part, (*path, i))


def put(holder, key, path, new):
    """Put a tree in place of another."""
    if not path:
        holder[key] = new
        return
    place = holder[key]
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = new


def sides(record):
    """Where expressions stand in relations: right sides, and left sides that are no names."""
    for relation in relations(record):
        yield relation, "right"
        if isinstance(relation["left"], list) and relation["left"][0] != "Subscript":
            yield relation, "left"


def changed_node(record, draw, wanted, change):
    """The record with one part of an expression, of those wanted, changed."""
    places = [(h, k, path, node) for h, k in sides(record) for path, node in nodes(h[k]) if wanted(node)]
    if not places:
        return None
    holder, key, path, node = draw.choice(places)
    put(holder, key, path, change(node))
    return record


def changed_relation(record, draw, change):
    """The record with the right side of one relation changed."""
    found = relations(record)
    if not found:
        return None
    relation = draw.choice(found)
    relation["right"] = change(relation["right"])
    return record


def names_in(record):
    return [*record["system"]["coordinates"], *record["system"]["velocities"], *record["system"]["parameters"]]


# ---- algebra ----


def is_head(*heads):
    return lambda node: isinstance(node, list) and node[0] in heads


@of_class("sign", algebra=True)
def _(record, draw):
    return changed_node(record, draw, lambda node: node != 0, lambda node: ["Multiply", -1, node])


@of_class("factor 2", algebra=True)
def _(record, draw):
    return changed_node(record, draw, lambda node: node != 0, lambda node: ["Multiply", 2, node])


@of_class("dropped term", algebra=True)
def _(record, draw):
    def drop(node):
        remaining = list(node)
        del remaining[draw.randrange(1, len(node))]
        return remaining if len(remaining) > 2 else remaining[1]

    return changed_node(record, draw, lambda node: is_head("Add", "Multiply")(node) and len(node) > 2, drop)


@of_class("exponent", algebra=True)
def _(record, draw):
    return changed_node(record, draw, is_head("Power"), lambda node: ["Power", node[1], ["Add", node[2], 1]])


@of_class("symbol", algebra=True)
def _(record, draw):
    names = names_in(record)
    change = lambda node: draw.choice([name for name in names if name != node])  # noqa: E731
    return changed_node(record, draw, lambda node: node in names, change)


@of_class("constant", algebra=True)
def _(record, draw):
    wanted = lambda node: isinstance(node, int) and node not in (0, -1)  # noqa: E731
    return changed_node(record, draw, wanted, lambda node: node + draw.choice((-1, 1, 2)))


@of_class("off by 1e-12", algebra=True)
def _(record, draw):
    small = ["Add", 1, ["Rational", 1, 10**12]]
    return changed_node(record, draw, lambda node: node != 0, lambda node: ["Multiply", small, node])


@of_class("off by 1e-40", algebra=True)
def _(record, draw):
    name = draw.choice(names_in(record))
    small = ["Multiply", ["Rational", 1, {"num": str(10**40)}], name]
    return changed_relation(record, draw, lambda right: ["Add", right, small])


@of_class("decimal", algebra=True)
def _(record, draw):
    size = draw.choice(("1.001e0", "1.0000001e0", "1.1e0"))
    return changed_node(record, draw, lambda node: node != 0, lambda node: ["Multiply", {"num": size}, node])


@of_class("tiny decimal term", algebra=True)
def _(record, draw):
    name = draw.choice(names_in(record))
    return changed_relation(record, draw, lambda right: ["Add", right, ["Multiply", {"num": "1.5e-12"}, name]])


@of_class("sides swapped", algebra=True)
def _(record, draw):
    found = [equation for equation in equations(record) if len(equation["relations"]) > 1]
    if not found:
        return None
    first, second = draw.sample(draw.choice(found)["relations"], 2)
    first["right"], second["right"] = second["right"], first["right"]
    return record


@of_class("rate in place of its coordinate", algebra=True)
def _(record, draw):
    system = record["system"]
    rates = dict(zip(system["coordinates"], system["velocities"], strict=True))
    return changed_node(record, draw, lambda node: isinstance(node, str) and node in rates, lambda node: rates[node])


@of_class("coordinate in place of its initial value", algebra=True)
def _(record, draw):
    moving = [*record["system"]["coordinates"], *record["system"]["velocities"]]
    wanted = lambda node: isinstance(node, str) and node.removesuffix("_0") in moving and node not in moving  # noqa: E731
    return changed_node(record, draw, wanted, lambda node: node.removesuffix("_0"))


# ---- branches, domains, narrow ranges ----


@of_class("branch of abs")
def _(record, draw):
    return changed_node(record, draw, is_head("Abs"), lambda node: ["Multiply", draw.choice((-1, 1)), node[1]])


@of_class("branch of sign")
def _(record, draw):
    return changed_node(record, draw, is_head("Sign"), lambda node: draw.choice((-1, 1)))


@of_class("constant in abs or sign")
def _(record, draw):
    small = ["Rational", draw.choice((-1, 1)), draw.choice((3, 1000))]
    return changed_node(record, draw, is_head("Abs", "Sign"), lambda node: [node[0], ["Add", node[1], small]])


@of_class("kink far away")
def _(record, draw):
    far, name = draw.choice((50, 1000, 10**5)), draw.choice(names_in(record))
    beyond = ["Add", ["Abs", ["Add", name, -far]], name, -far]
    return changed_relation(record, draw, lambda right: ["Add", right, beyond])


@of_class("root taken apart")
def _(record, draw):
    def apart(node):
        return ["Multiply", *(["Sqrt", part] for part in node[1][1:])]

    wanted = lambda node: is_head("Sqrt")(node) and is_head("Multiply")(node[1])  # noqa: E731
    return changed_node(record, draw, wanted, apart)


@of_class("logarithm taken apart")
def _(record, draw):
    def apart(node):
        if node[1][0] == "Power":
            return ["Multiply", node[1][2], ["Ln", node[1][1]]]
        return ["Add", *(["Ln", part] for part in node[1][1:])]

    wanted = lambda node: is_head("Ln")(node) and is_head("Multiply", "Power")(node[1])  # noqa: E731
    return changed_node(record, draw, wanted, apart)


@of_class("other branch of a root")
def _(record, draw):
    wanted = lambda node: is_head("Sqrt")(node) and not isinstance(node[1], int)  # noqa: E731
    return changed_node(record, draw, wanted, lambda node: ["Multiply", -1, node])


@of_class("narrow well")
def _(record, draw):
    name = draw.choice(names_in(record))
    well = ["Exp", ["Multiply", -(10 ** draw.choice((2, 4, 8))), ["Power", ["Add", name, -draw.choice((1, 3))], 2]]]
    return changed_relation(record, draw, lambda right: ["Add", right, well])


@of_class("no value")
def _(record, draw):
    name = draw.choice(names_in(record))
    negative = ["Add", -1, ["Multiply", -1, ["Power", name, 2]]]
    return changed_relation(record, draw, lambda right: ["Add", right, [draw.choice(("Sqrt", "Ln")), negative]])


# ---- relations and equations ----


def some_equation(record, draw, fewest=1):
    found = [equation for equation in equations(record) if len(equation["relations"]) >= fewest]
    return draw.choice(found) if found else None


@of_class("relation dropped")
def _(record, draw):
    if equation := some_equation(record, draw):
        del equation["relations"][draw.randrange(len(equation["relations"]))]
    return record


@of_class("contradiction before or after")
def _(record, draw):
    if equation := some_equation(record, draw):
        twice = copy.deepcopy(draw.choice(equation["relations"]))
        twice["right"] = ["Add", twice["right"], 7]
        equation["relations"].insert(draw.choice((0, len(equation["relations"]))), twice)
    return record


@of_class("stray relation")
def _(record, draw):
    strays = ("A", "T0", "B", "A_inverse", "Lambda", "christoffel", "residual", "lambda1", "x", ["Subscript", "T0", 1])
    if equation := some_equation(record, draw, 0):
        place = draw.randint(0, len(equation["relations"]))
        equation["relations"].insert(place, {"left": draw.choice(strays), "right": 42})
    return record


@of_class("index of a left side")
def _(record, draw):
    found = [r for r in relations(record) if isinstance(r["left"], list) and r["left"][0] == "Subscript"]
    if not found:
        return None
    left = draw.choice(found)["left"]
    left[draw.randrange(2, len(left))] += draw.choice((-1, 1))
    return record


@of_class("name of a left side")
def _(record, draw):
    found = [relation for relation in relations(record) if isinstance(relation["left"], str)]
    if not found:
        return None
    relation = draw.choice(found)
    relation["left"] = draw.choice([f"{relation['left']}_0", *record["system"]["accelerations"]])
    return record


@of_class("relations out of order")
def _(record, draw):
    equation = some_equation(record, draw, 2)
    if equation is None:
        return None
    first = draw.randrange(len(equation["relations"]) - 1)
    pair = equation["relations"][first : first + 2]
    equation["relations"][first : first + 2] = pair[::-1]
    return record if equation["id"] != "determined_initial_values" else None


@of_class("christoffel partner")
def _(record, draw):
    found = [equation for equation in named(record, "christoffel_symbols") if equation["relations"]]
    if not found:
        return None
    equation = draw.choice(found)
    _, name, k, m, s = draw.choice(equation["relations"])["left"]
    equation["relations"].append({"left": ["Subscript", name, m, k, s], "right": ["Multiply", 7, s]})
    return record


@of_class("equation dropped")
def _(record, draw):
    part = draw.choice(parts(record))
    del part["equations"][draw.randrange(len(part["equations"]))]
    return record


@of_class("equation twice")
def _(record, draw):
    part = draw.choice(parts(record))
    equation = copy.deepcopy(draw.choice(part["equations"]))
    for relation in equation["relations"]:
        relation["right"] = 42
    part["equations"].insert(draw.randint(0, len(part["equations"])), equation)
    return record


@of_class("equations swapped")
def _(record, draw):
    part = draw.choice(parts(record))
    first, second = draw.sample(range(len(part["equations"])), 2)
    part["equations"][first], part["equations"][second] = part["equations"][second], part["equations"][first]
    return record


@of_class("ids swapped")
def _(record, draw):
    first, second = draw.sample(draw.choice(parts(record))["equations"], 2)
    first["id"], second["id"] = second["id"], first["id"]
    return record


@of_class("number of an equation")
def _(record, draw):
    draw.choice(equations(record))["number"] = draw.choice(("99", "", "3", "12"))
    return record


@of_class("name of an equation")
def _(record, draw):
    draw.choice(equations(record))["name"] = draw.choice(("constraint forces", "", "multipliers", "initial state"))
    return record


@of_class("emptied equation")
def _(record, draw):
    if equation := some_equation(record, draw):
        equation["relations"] = []
    return record


@of_class("closed forms dropped")
def _(record, draw):
    found = [part for part in record["derivations"] if {e["number"] for e in part["equations"]} & CLOSED]
    if not found:
        return None
    part = draw.choice(found)
    part["equations"] = [e for e in part["equations"] if e["number"] not in CLOSED]
    if draw.random() < 0.7:
        part["closed_form_operations"] = None
        for scene in record["scenes"]:
            scene["equations"] = [e for e in scene["equations"] if e["number"] in ("12", "19")]
    if draw.random() < 0.5:
        part["left_out"] = {"numbers": sorted(CLOSED, key=int), "size": 900, "limit": draw.choice((500, 1))}
    return record


# ---- what is said besides ----


@of_class("left out")
def _(record, draw):
    part = draw.choice(parts(record))
    left_out = part["left_out"] or {"numbers": ["4"], "size": 900, "limit": 500}
    changes = {"size": left_out["size"] + 1, "limit": left_out["limit"] - 1, "numbers": left_out["numbers"][:-1]}
    key = draw.choice(sorted(changes))
    part["left_out"] = left_out | {key: changes[key]} if part["left_out"] else left_out
    return record


@of_class("closed form operations")
def _(record, draw):
    part = draw.choice(record["derivations"])
    count = part["closed_form_operations"]
    part["closed_form_operations"] = draw.choice((1, None, count + 1)) if count is not None else 7
    return record


@of_class("mass matrix")
def _(record, draw):
    part = draw.choice(record["derivations"])
    part["mass_matrix"] = "supported" if part["mass_matrix"] == "regular" else "regular"
    return record


@of_class("redundancy")
def _(record, draw):
    part = draw.choice(record["derivations"])
    names = record["system"]["multipliers"]
    wrong = [[], ["lambda99"], names[:1], names[-1:], names]
    part["redundant"] = draw.choice([each for each in wrong if each != part["redundant"]])
    return record


@of_class("effects of a derivation")
def _(record, draw):
    part = draw.choice(record["derivations"])
    part["effects"] = draw.choice((part["effects"][:-1], part["effects"][::-1], [*part["effects"], "another"]))
    return record


@of_class("system")
def _(record, draw):
    system = record["system"]
    lists = [key for key, value in system.items() if isinstance(value, list) and value]
    key = draw.choice(lists)
    system[key] = draw.choice((system[key][:-1], system[key][::-1], [*system[key], system[key][0]]))
    return record


@of_class("system's energies, forces, constraints")
def _(record, draw):
    system = record["system"]
    part = draw.choice([*system["kinetic_energy"], *system["potential_energy"]])
    if draw.random() < 0.5 or not system["constraints"]:
        part["value"] = ["Multiply", 2, part["value"]]
    else:
        system["constraints"][0] = ["Add", system["constraints"][0], 1]
    return record


@of_class("title")
def _(record, draw):
    draw.choice([record["system"], *record["scenes"]])["title"] = "another title"
    return record


# ---- scenes ----


def scene_class(name):
    """A class that needs a scene."""

    def noted(function):
        def made(record, draw):
            return function(record, draw, draw.choice(record["scenes"])) if record["scenes"] else None

        return of_class(name)(made)

    return noted


@scene_class("scene dropped")
def _(record, draw, scene):
    record["scenes"].remove(scene)
    return record


@scene_class("scene twice")
def _(record, draw, scene):
    twice = copy.deepcopy(scene)
    twice["name"] = draw.choice((scene["name"], "another"))
    record["scenes"].append(twice)
    return record


@scene_class("scene emptied")
def _(record, draw, scene):
    scene["equations"] = []
    return record


@scene_class("scenes out of order")
def _(record, draw, scene):
    record["scenes"] = record["scenes"][::-1]
    return record


@scene_class("name of a scene")
def _(record, draw, scene):
    scene["name"] = f"{scene['name']}_0"
    return record


@scene_class("effects of a scene")
def _(record, draw, scene):
    scene["effects"] = draw.choice((scene["effects"][:-1], scene["effects"][::-1], [*scene["effects"], "another"]))
    return record


@scene_class("derivation of a scene")
def _(record, draw, scene):
    scene["derivation"] = (scene["derivation"] + 1) % len(record["derivations"])
    return record


@scene_class("parameter value")
def _(record, draw, scene):
    if not scene["parameter_values"]:
        return None
    name = draw.choice(sorted(scene["parameter_values"]))
    scene["parameter_values"][name] = ["Add", scene["parameter_values"][name], ["Rational", 1, draw.choice((2, 10**9))]]
    return record


@scene_class("parameter values swapped")
def _(record, draw, scene):
    values = scene["parameter_values"]
    if len(values) < 2:
        return None
    first, second = draw.sample(sorted(values), 2)
    values[first], values[second] = values[second], values[first]
    return record


@scene_class("parameter value left out")
def _(record, draw, scene):
    if not scene["parameter_values"]:
        return None
    scene["parameter_values"].popitem()
    return record


@scene_class("control law")
def _(record, draw, scene):
    if not scene["control_law"]:
        return None
    name = draw.choice(sorted(scene["control_law"]))
    law = scene["control_law"][name]
    changes = (["Add", law, ["Power", "t", 4]], ["Multiply", 2, law], ["Power", law, 2], ["Add", law, 1])
    scene["control_law"][name] = draw.choice(changes)
    return record


@scene_class("time span")
def _(record, draw, scene):
    if scene["time_span"] is None:
        scene["time_span"] = [0, 1]
    else:
        k = draw.randrange(2)
        scene["time_span"][k] = ["Add", scene["time_span"][k], ["Rational", 1, draw.choice((2, 10**9))]]
    return record


@scene_class("observe")
def _(record, draw, scene):
    scene["observe"] = draw.choice((scene["observe"][:-1], [*scene["observe"], "energy"]))
    return record


@scene_class("given")
def _(record, draw, scene):
    others = [name for name in scene["initial_state"] if name not in scene["given"]]
    changes = [scene["given"][:-1], scene["given"][::-1], *([[*scene["given"], others[-1]]] if others else [])]
    scene["given"] = draw.choice(changes)
    return record


@scene_class("determined said to be given")
def _(record, draw, scene):
    others = [name for name in scene["initial_state"] if name not in scene["given"]]
    if not others:
        return None
    scene["given"] = [*scene["given"], *others]
    for equation in scene["equations"]:
        if equation["id"] == "determined_initial_values":
            equation["relations"] = []
    return record


@scene_class("correction")
def _(record, draw, scene):
    name = f"{next(iter(scene['initial_state']))}_0"
    scene["correction"] = None if scene["correction"] else {"name": name, "size": draw.choice(("0.5", "1e-12"))}
    return record


@scene_class("law around start")
def _(record, draw, scene):
    scene["law_around_start"] = not scene.get("law_around_start", False)
    return record


@scene_class("start in one place")
def _(record, draw, scene):
    name = draw.choice(sorted(scene["initial_state"]))
    scene["initial_state"][name] = ["Add", scene["initial_state"][name], ["Rational", 1, draw.choice((2, 10**20))]]
    return record


@scene_class("start everywhere")
def _(record, draw, scene):
    name = draw.choice(sorted(scene["initial_state"]))
    moved = ["Add", scene["initial_state"][name], ["Rational", 1, draw.choice((2, 10**20))]]
    scene["initial_state"][name] = moved
    for equation in scene["equations"]:
        if equation["id"] == "initial_state":
            for relation in equation["relations"]:
                if relation["left"] == f"{name}_0":
                    relation["right"] = moved
    return record


@scene_class("determined value in numbers")
def _(record, draw, scene):
    found = [r for e in scene["equations"] if e["id"] == "determined_initial_values" for r in e["relations"]]
    found = [each for each in found if isinstance(each["right"], list) and each["right"][0] != "Rational"]
    if not found:
        return None
    relation = draw.choice(found)
    relation["right"] = scene["initial_state"][relation["left"].removesuffix("_0")]
    return record


@scene_class("root of a determined value")
def _(record, draw, scene):
    found = [r for e in scene["equations"] if e["id"] == "determined_initial_values" for r in e["relations"]]
    found = [relation for relation in found if "Sqrt" in json.dumps(relation["right"])]
    if not found:
        return None
    relation = draw.choice(found)
    relation["right"] = ["Multiply", -1, relation["right"]]
    return record


@of_class("empty")
def _(record, draw):
    key = draw.choice(("derivations", "scenes", "both"))
    for each in ("derivations", "scenes") if key == "both" else (key,):
        record[each] = []
    return record
