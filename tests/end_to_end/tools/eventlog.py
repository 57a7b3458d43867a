"""Event logs of ours, taken apart and put together again with checks and digests made anew, as another simulator would make
them. The files in lcm_types describe a message's bytes."""
import functools
import os
import re
import struct

TYPES = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..', 'lcm_types')
SIZES = {'int8_t': 1, 'boolean': 1, 'byte': 1, 'int16_t': 2, 'int32_t': 4, 'float': 4, 'int64_t': 8, 'double': 8}
MASK = (1 << 64) - 1


def word(h, w):
    h = ((h ^ w) * 0x9e3779b97f4a7c15) & MASK
    return h ^ (h >> 32)


def check(data):
    h = 0x6a09e667f3bcc908
    for i in range(0, len(data), 8):
        h = word(h, int.from_bytes(data[i:i + 8].ljust(8, b'\0'), 'big'))
    return h or 1


def seal(data):
    return data[:-8] + check(data[:-8]).to_bytes(8, 'big')


def parse(name):
    """[time, channel, data] of each event."""
    data, events, at = open(name, 'rb').read(), [], 0
    while at < len(data):
        c, n = struct.unpack('>II', data[at + 20:at + 28])
        begin = at + 28 + c
        events.append([int.from_bytes(data[at + 12:at + 20], 'big'), data[at + 28:begin].decode(), data[begin:begin + n]])
        at = begin + n
    return events


def write(name, events):
    digest, out = 0, b''
    for n, (t, c, m) in enumerate(events):
        if c == 'WAFERHAND_RECORDING':
            m = seal(m[:-32] + n.to_bytes(8, 'big') + m[-24:-16] + digest.to_bytes(8, 'big') + b'\0' * 8)
        out += b'\xed\xa1\xda\x01' + n.to_bytes(8, 'big') + t.to_bytes(8, 'big') + struct.pack('>II', len(c), len(m)) + c.encode() + m
        if c.startswith('WAFERHAND'):
            digest = word(word(digest, check(c.encode())), check(m))
    open(name, 'wb').write(out)


@functools.lru_cache(maxsize=None)
def members(kind):
    """(type, name, dimensions) of each member, as lcm_types/KIND.lcm has them."""
    text = re.sub(r'//[^\n]*', '', open(os.path.join(TYPES, kind + '.lcm')).read())
    body = re.search(r'struct \w+ \{(.*)\}', text, re.S).group(1)
    return [(t, n, re.findall(r'\[(\w+)\]', d)) for t, n, d in re.findall(r'([\w.]+)\s+(\w+)((?:\[\w+\])*)\s*;', body)]


def walk(kind, data, at, path, found):
    """Appends (path, type, byte, size) of each plain value from `at` on; returns where they end."""
    counts = {}
    for member, name, dimensions in members(kind):
        total = 1
        for d in dimensions:
            total *= int(d) if d.isdigit() else counts[d]
        for i in range(total):
            here = path + [name + (f'[{i}]' if dimensions else '')]
            if member == 'string':
                n = int.from_bytes(data[at:at + 4], 'big')
                found.append(('.'.join(here), member, at + 4, n - 1))
                at += 4 + n
            elif member in SIZES:
                size = SIZES[member]
                if size == 4 and member == 'int32_t':
                    counts[name] = int.from_bytes(data[at:at + 4], 'big', signed=True)
                found.append(('.'.join(here), member, at, size))
                at += size
            else:
                at = walk(member, data, at, here, found)
    return at


def fields(kind, data):
    """(path, type, byte, size) of each plain value in an encoded message, behind its fingerprint."""
    found = []
    end = walk(kind, data, 8, [], found)
    assert end == len(data), (kind, end, len(data))
    return found


def value(data, field):
    _, kind, at, size = field
    if kind == 'double':
        return struct.unpack('>d', data[at:at + 8])[0]
    return int.from_bytes(data[at:at + size], 'big', signed=True)
