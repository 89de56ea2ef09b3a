"""Damages one attribute of a sweep's file. The attribute belongs to the file itself or to one of its columns."""

import h5py

from launch import run
from samples import FILE, SALVAGED, SEAL, check_complete, check_readers, check_resumed, samples


class Faults:
    def __init__(self, folder):
        self.samples = samples(folder)
        self.attributes = {}
        for sample in self.samples:
            with h5py.File(sample.path) as file:
                places = {"/": list(file.attrs), "runs": list(file["runs"].attrs)}
            self.attributes[sample.name] = [(place, name) for place, names in places.items() for name in names]

    def try_one(self, case):
        sample = case.chance.choice(self.samples)
        place, name = case.chance.choice(self.attributes[sample.name])
        path = case.folder / FILE
        path.write_bytes(sample.content)
        with h5py.File(path, "r+") as file:
            way = case.chance.choice([self.flip, self.empty, self.remove])
            way(case.chance, file[place].attrs, name)
        content = path.read_bytes()
        if case.chance.random() < 0.5 and SEAL in content:  # A copy by another program has no seal.
            path.write_bytes(content[:content.rindex(SEAL)])
        case.note(f"{sample.name}: {way.__name__} {place} {name}")
        check_readers(case, sample)
        self.check_salvaged(case, sample)
        (case.folder / SALVAGED).unlink(missing_ok=True)
        check_resumed(case, sample.sweep, sample.rows)

    @staticmethod
    def check_salvaged(case, sample):
        """Checks what salvage keeps. All rows are intact, so salvage keeps all of them. The sweep's command restores
        the rest of the file."""
        salvaged = case.folder / SALVAGED
        salvaged.unlink(missing_ok=True)
        run(case, "clogsweep", "salvage", FILE, "--output", SALVAGED)
        case.expect(salvaged.exists(), "clogsweep salvage: gives nothing back of whole rows")
        if not salvaged.exists():
            return
        check_complete(case, salvaged, sample.rows, ignored=[])
        again = run(case, "clogsweep", *sample.sweep[:-1], SALVAGED)
        case.expect(again.code == 0, f"clogsweep: does not resume with a salvaged file, exit code {again.code}")
        case.expect(run(case, "clogsweep", "verify", SALVAGED).code == 0,
                    "clogsweep verify: finds faults in a salvaged file after a resume")
        check_complete(case, salvaged, sample.rows)

    @staticmethod
    def flip(chance, attributes, name):
        value = attributes[name]
        content = bytearray(value if isinstance(value, bytes) else str(value).encode())
        if content:
            content[chance.randrange(len(content))] ^= 1 << chance.randrange(7)
            attributes.modify(name, bytes(content))

    @staticmethod
    def empty(_, attributes, name):
        attributes.modify(name, b"")

    @staticmethod
    def remove(_, attributes, name):
        del attributes[name]
