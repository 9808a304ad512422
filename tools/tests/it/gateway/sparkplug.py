"""Reads messages of Sparkplug B, one "TOPIC HEX" a line, checks them by the rules of an edge node and
prints each as JSON. Written from the text of sparkplug_b.proto and of the specification 3.0, with
nothing of the gateway's.

Exit status 1, and the rule, at the first message that breaks one."""

import json
import struct
import sys

INT8, INT16, INT32, INT64, UINT8, UINT16, UINT32, UINT64 = range(1, 9)
FLOAT, DOUBLE, BOOLEAN, STRING, DATETIME, TEXT = range(9, 15)
BYTES = 17

# Field numbers of message Metric that carry a value, by the data types that use them.
VALUE_FIELDS = {
    10: {INT8, INT16, INT32, UINT8, UINT16, UINT32},
    11: {INT64, UINT64, DATETIME},
    12: {FLOAT},
    13: {DOUBLE},
    14: {BOOLEAN},
    15: {STRING, TEXT},
    16: {BYTES},
}
SIGNED = {INT8: 32, INT16: 32, INT32: 32, INT64: 64}
BITS = {UINT8: 8, UINT16: 16, UINT32: 32, INT8: 32, INT16: 32, INT32: 32}


def check(holds, rule):
    if not holds:
        raise ValueError(rule)


def varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
        shift += 7


def fields(data):
    """Number, wire type and value of each field of a message."""
    at = 0
    while at < len(data):
        key, at = varint(data, at)
        number, wire = key >> 3, key & 7
        if wire == 0:
            value, at = varint(data, at)
        elif wire == 1:
            value, at = data[at : at + 8], at + 8
        elif wire == 2:
            length, at = varint(data, at)
            check(at + length <= len(data), "a field ends behind its message")
            value, at = data[at : at + length], at + length
        elif wire == 5:
            value, at = data[at : at + 4], at + 4
        else:
            raise ValueError(f"wire type {wire}")
        yield number, wire, value


def metric(data):
    found = {}
    for number, wire, value in fields(data):
        if number == 1:
            found["name"] = value.decode()
        elif number == 2:
            found["alias"] = value
        elif number == 3:
            found["timestamp"] = value
        elif number == 4:
            found["datatype"] = value
        elif number == 5:
            found["is_historical"] = bool(value)
        elif number == 7:
            found["is_null"] = bool(value)
        elif number in VALUE_FIELDS:
            check("field" not in found, "two values")
            found["field"] = number
            expected = {10: 0, 11: 0, 12: 5, 13: 1, 14: 0, 15: 2, 16: 2}[number]
            check(wire == expected, f"wire type {wire} of field {number}")
            found["value"] = value
        else:
            raise ValueError(f"field {number} of a metric")
    check("name" in found and "alias" not in found, "a metric has a name and no alias here")
    check("timestamp" in found, f"{found['name']}: no timestamp")
    check("datatype" in found, f"{found['name']}: no datatype")
    if found.get("is_null"):
        check("field" not in found, f"{found['name']}: null, with a value")
        found["value"] = None
        return found
    check("field" in found, f"{found['name']}: neither null nor a value")
    kind, value = found["datatype"], found["value"]
    check(kind in VALUE_FIELDS[found["field"]], f"{found['name']}: type {kind} in field {found['field']}")
    if kind in BITS:
        check(value < 1 << BITS[kind], f"{found['name']}: {value} of type {kind}")
    if kind in SIGNED and value >> (SIGNED[kind] - 1):
        value -= 1 << SIGNED[kind]
    elif kind == FLOAT:
        value = struct.unpack("<f", value)[0]
    elif kind == DOUBLE:
        value = struct.unpack("<d", value)[0]
    elif kind == BOOLEAN:
        value = bool(value)
    elif kind in (STRING, TEXT):
        value = value.decode()
    elif kind == BYTES:
        value = value.hex(" ").upper()
    found["value"] = value
    return found


def payload(data):
    found = {"metrics": []}
    for number, wire, value in fields(data):
        if number == 1:
            found["timestamp"] = value
        elif number == 2:
            found["metrics"].append(metric(value))
        elif number == 3:
            check("seq" not in found and value <= 255, "seq is 0 to 255, once")
            found["seq"] = value
        else:
            raise ValueError(f"field {number} of a payload")
    check("timestamp" in found, "a payload without timestamp")
    return found


class Node:
    """What a host knows of an edge node."""

    def __init__(self):
        self.seq = None
        self.bd_seq = None
        self.is_born = False
        self.devices = {}

    def hear(self, kind, device, message):
        values = {metric["name"]: metric for metric in message["metrics"]}
        check(len(values) == len(message["metrics"]), "one metric twice")
        if kind == "NDEATH":
            check("seq" not in message, "NDEATH has no seq")
            check(list(values) == ["bdSeq"], "NDEATH has bdSeq alone")
            # One of a connection before may come late.
            if values["bdSeq"]["value"] == self.bd_seq:
                self.is_born, self.devices = False, {}
            return
        check("seq" in message, f"{kind} without seq")
        if kind == "NBIRTH":
            check(message["seq"] == 0, "the seq of NBIRTH is 0")
            check("bdSeq" in values and values["bdSeq"]["datatype"] == INT64, "NBIRTH without bdSeq")
            rebirth = values.get("Node Control/Rebirth")
            check(rebirth and rebirth["datatype"] == BOOLEAN, "NBIRTH without Node Control/Rebirth")
            check(rebirth["value"] is False, "Node Control/Rebirth is false")
            number = values["bdSeq"]["value"]
            check(0 <= number <= 255, "bdSeq is 0 to 255")
            # Connections that were not made have numbers of their own.
            is_next = self.bd_seq is None or 1 <= (number - self.bd_seq) % 256 < 128
            check(is_next or (self.is_born and number == self.bd_seq), f"bdSeq {number} after {self.bd_seq}")
            self.bd_seq, self.is_born, self.devices = number, True, {}
        else:
            check(self.is_born, f"{kind} before NBIRTH")
            check(message["seq"] == (self.seq + 1) % 256, f"seq {message['seq']} after {self.seq}")
        self.seq = message["seq"]
        if kind == "DBIRTH":
            check(values, "an empty birth")
            self.devices[device] = {name: metric["datatype"] for name, metric in values.items()}
        elif kind == "DDEATH":
            check(device in self.devices, f"death of {device}, which was not born")
            del self.devices[device]
        elif kind == "DDATA":
            check(device in self.devices, f"data of {device}, which was not born")
            check(values, "data without metrics")
            for name, found in values.items():
                known = self.devices[device].get(name)
                check(known == found["datatype"], f"{name}: type {found['datatype']}, born as {known}")
        else:
            check(kind == "NBIRTH", kind)


def main():
    nodes = {}
    for line in sys.stdin:
        topic, _, data = line.rstrip("\n").partition(" ")
        levels = topic.split("/")
        try:
            check(levels[0] == "spBv1.0" and len(levels) in (4, 5), "no topic")
            group, kind, node, device = (levels + [None])[1:5]
            check((device is not None) == kind.startswith("D"), "a device for D..., and for those alone")
            message = payload(bytes.fromhex(data))
            nodes.setdefault((group, node), Node()).hear(kind, device, message)
        except (ValueError, IndexError) as error:
            sys.exit(f"{topic}: {error}")
        print(json.dumps({"kind": kind, "node": node, "device": device, **message}))


main()
