"""Damages bytes in several ways."""

NUMBERS = [0, 1, 2, 63, 64, 255, 2**15, 2**16 - 1, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**63, 2**64 - 1]


def overwrite(chance, content, places):
    for place in piece(chance, places, 64):
        content[place] = chance.randrange(256)


def put_a_number(chance, content, places):
    """Overwrites some bytes with a number. A reader could take it for an offset, a size or a count."""
    width = chance.choice([1, 2, 4, 8])
    number = chance.choice([*NUMBERS, len(content), chance.randrange(2 * len(content))]) % 256**width
    begin = chance.choice(places) // width * width
    content[begin:begin + width] = number.to_bytes(width, "little")


def swap(chance, content, places):
    one, other = piece(chance, places, 256), piece(chance, places, 256)
    for a, b in zip(one, other):
        content[a], content[b] = content[b], content[a]


def empty(chance, content, places):
    for place in piece(chance, places, 512):
        content[place] = 0


def truncate(chance, content, places):
    del content[chance.randrange(len(content)):]


def append(chance, content, places):
    content += chance.randbytes(chance.randint(1, 4096))


WAYS = [overwrite, put_a_number, swap, empty, truncate, append]


def piece(chance, places, longest):
    begin = chance.randrange(len(places))
    return places[begin:begin + chance.randint(1, longest)]


def harm(chance, content, places):
    """Damages the bytes at some of the places, in a random way. @return the name of the way, and the bytes"""
    way = chance.choice(WAYS)
    harmed = bytearray(content)
    way(chance, harmed, places)
    return way.__name__, bytes(harmed)
