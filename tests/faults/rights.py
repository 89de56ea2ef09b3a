"""Modes, owners and groups of a sweep's files, and links of others: whatever they are, the sweep leaves them so."""

import os
import stat

import kills
from launch import run
from samples import FILE, check_complete
from support import TIMING

SWEEP = kills.SWEEP
STRANGERS = [12, 1234, 65534]  # users and groups that are not ours; only root can give files to them
MODES = [0o600, 0o640, 0o644, 0o660, 0o664, 0o666, 0o400, 0o440, 0o700]
MASKS = [0o022, 0o077, 0o002, 0o000, 0o027]


class Faults:
    def __init__(self, folder):
        self.usual = kills.Faults(folder)

    def try_one(self, case):
        case.chance.choice([self.grow, self.grow, self.begin, self.meet_a_link])(case)

    def begin(self, case):
        """A new file has the rights that the umask leaves, and so has its journal while it runs."""
        mask = case.chance.choice(MASKS)
        case.note(f"umask {mask:03o}")
        outcome = run(case, "clogsweep", *SWEEP, "--max-hours=1e-5", prepare=lambda: os.umask(mask), exit_codes={0, 75})
        case.note(f"exit code {outcome.code}")
        for path in case.folder.iterdir():
            case.expect(mode_of(path) == 0o666 & ~mask, f"{self.role(path)}: mode {mode_of(path):03o}")

    def grow(self, case):
        """A file that is written again, after a stop at any moment, keeps mode, owner and group."""
        run(case, "clogsweep", *SWEEP, f"--max-hours={case.chance.uniform(1e-5, self.usual.duration / 3600)}", exit_codes={0, 75})
        path = case.folder / FILE
        owners = [case.chance.choice([-1, *STRANGERS]) for _ in range(2)] if os.geteuid() == 0 else [-1, -1]
        mode = case.chance.choice([mode for mode in MODES if os.geteuid() == 0 or mode & 0o600 == 0o600])
        os.chown(path, *owners)
        path.chmod(mode)
        before = rights_of(path)
        case.note(f"mode {mode:03o}, owner and group {before[1:]}")
        mask = case.chance.choice(MASKS)
        outcome = run(case, "clogsweep", *SWEEP, prepare=lambda: os.umask(mask), ranks=case.chance.choice([None, kills.RANKS]))
        case.expect(outcome.code == 0, f"clogsweep: does not resume, exit code {outcome.code}")
        case.expect(rights_of(path) == before, f"a table's rights changed: {before} to {rights_of(path)}")
        check_complete(case, path, self.usual.rows, ignored=[*TIMING, "attempt"])

    def meet_a_link(self, case):
        """In a folder where everybody may make files, only links of the same user, or of the folder's owner, are followed."""
        shared = case.folder / "shared"
        shared.mkdir()
        shared.chmod(0o1777)
        name = case.chance.choice([FILE, FILE + ".journal"])
        link = shared / name
        target = case.folder / case.chance.choice(["elsewhere", "there"])
        if target.name == "there":
            target.write_bytes(case.chance.randbytes(case.chance.choice([0, 10, 5000])))
        before = target.read_bytes() if target.exists() else None
        link.symlink_to(target)
        owner = case.chance.choice(STRANGERS) if os.geteuid() == 0 else os.geteuid()
        os.lchown(link, owner, owner)
        case.note(f"{name} leads to {target.name}, made by {owner}")
        outcome = run(case, "clogsweep", *SWEEP[:-1], f"shared/{FILE}", exit_codes={0, 2})
        if owner != os.geteuid():
            case.expect(outcome.code == 2, "clogsweep: follows a link of somebody else")
            case.expect((target.read_bytes() if target.exists() else None) == before, "a file behind a link of somebody else was changed")

    @staticmethod
    def role(path):
        return "the journal" if path.suffix == ".journal" else "the table"


def mode_of(path):
    return stat.S_IMODE(path.stat().st_mode)


def rights_of(path):
    status = path.stat()
    return mode_of(path), status.st_uid, status.st_gid
