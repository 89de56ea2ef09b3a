"""Files of circles with names of any bytes: none of them sets a key, ends the sweep, or is lost on the way."""

import os
import subprocess

from launch import command, quoted, run
from samples import FILE, check_complete, stored_rows

CIRCLES = "x,y,diameter\n2,3,0.6\n7,8,1\n"
SWEEP = ["obstacle-layout=file", "box=10", "vertices=64", "max-time=10", "line-tension=0.5,1", "--output", FILE]
PLAIN = "posts.csv"
# Text with a meaning in a config, in a list of values, or to printf.
PARTS = [b"\nline-tension = 0.1", b"\n", b"\r\n", b"#", b"\n#circles ", b" = ", b"\\x0a", b"\\", b"\\x", b"%", b"{}", b"(", b")", b"..", b"lin(1,2,3)",
         b"auto", b"\x1b[2J", b"\x7f", b"\xff", b"\xc2\x85", b"\xe2\x80\xa8", b" ", b"\t", b"'", b'"', b"$(date)"]
LONGEST = 200


class Faults:
    def __init__(self, folder):
        (folder / PLAIN).write_text(CIRCLES)
        subprocess.run(command("clogsweep", f"obstacles={PLAIN}", *SWEEP), cwd=folder, check=True, stderr=subprocess.DEVNULL)
        self.rows = stored_rows(folder / FILE)

    def try_one(self, case):
        name = self.name(case.chance)
        with open(os.path.join(os.fsencode(case.folder), name), "w") as file:
            file.write(CIRCLES)
        words = [os.fsdecode(b"obstacles=" + name), *SWEEP]
        case.note(quoted(["clogsweep", *words]))
        ranks = case.chance.choice([None, 2])
        for _ in range(2):  # the second finds that all is done
            outcome = run(case, "clogsweep", *words, ranks=ranks)
            case.expect(outcome.code == 0, f"clogsweep: exit code {outcome.code}")
        if outcome.code == 0:
            check_complete(case, case.folder / FILE, self.rows)
        for program, *rest in (("clogsweep", "verify"), ("clogsweep", "status"), ("clogfit",)):
            outcome = run(case, program, *rest, FILE)
            case.expect(outcome.code == 0, f"{outcome.name}: exit code {outcome.code}")

    @staticmethod
    def name(chance):
        """A comma ends a name in a list, and blanks around it are no part of it."""
        others = bytes(byte for byte in range(1, 256) if byte not in b"/,")
        parts = [chance.choice(PARTS) if chance.random() < 0.5 else bytes(chance.choices(others, k=chance.randint(1, 8)))
                 for _ in range(chance.randint(1, 6))]
        name = b"".join(parts).replace(b",", b";")[:LONGEST].strip(b" \t")
        return name if name not in (b"", b".", b"..", b"none") and name != os.fsencode(FILE) else b"p" + name
