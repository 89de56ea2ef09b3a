"""Flips one bit of a finished sweep's file. The bit is in a row, in the description of the rows, or anywhere."""

from samples import FILE, check_readers, check_resumed, rows_place, samples


class Faults:
    def __init__(self, folder):
        self.samples = samples(folder)
        self.places = {sample.name: rows_place(sample.path) for sample in self.samples}

    def try_one(self, case):
        sample = case.chance.choice(self.samples)
        place = case.chance.choice([self.in_a_row, self.outside_the_rows, self.anywhere])(case, sample)
        bit = case.chance.randrange(8)
        case.note(f"{sample.name}: bit {bit} of byte {place}")
        content = bytearray(sample.content)
        content[place] ^= 1 << bit
        (case.folder / FILE).write_bytes(content)
        check_readers(case, sample)
        check_resumed(case, sample.sweep, sample.rows)

    def in_a_row(self, case, sample):
        begin, size, columns, _ = self.places[sample.name]
        row = case.chance.randrange(len(sample.rows))
        name = case.chance.choice(sorted(columns))
        offset, width = columns[name]
        case.note(f"column {name} of row {row}")
        return begin + row * size + offset + case.chance.randrange(width)

    def outside_the_rows(self, case, sample):
        begin, _, _, end = self.places[sample.name]
        place = case.chance.randrange(len(sample.content) - (end - begin))
        return place if place < begin else place + end - begin

    @staticmethod
    def anywhere(case, sample):
        return case.chance.randrange(len(sample.content))
