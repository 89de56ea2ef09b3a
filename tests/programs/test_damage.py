"""Tests that readers notice damage to files, and that salvage keeps intact parts."""

import contextlib
import io
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import unittest

import h5py
import pandas
import stored_rows
from support import BIN, QUICK, ROOT, ProgramTest, shared_sweep, table

sys.path.insert(0, str(ROOT / "analysis"))
import clogsweep  # noqa: E402
from clogsweep.reading import stored  # noqa: E402

SETTINGS = [*QUICK, "line-tension=0.5,2", "seeds=1..3", "--output", "s.h5"]
READERS = [("clogsweep", "status", "s.h5"), ("clogsweep", "replay", "s.h5", 0), ("clogfit", "s.h5"),
           ("clogsweep", *SETTINGS)]


def limit_memory(size):
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (size, size))


def may_limit_memory():
    return subprocess.run([BIN / "clogfit", "--version"], capture_output=True,
                          preexec_fn=lambda: limit_memory(2**31)).returncode == 0


class Damage(ProgramTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "s.h5"
        shutil.copyfile(shared_sweep(*SETTINGS[:-2]), self.file)
        self.rows = table(self.file)

    def multiply_a_distance(self):
        """Multiplies the distance of a clogged row by 16. A flipped bit in the exponent could do this."""
        content = self.file.read_bytes()
        self.file.write_bytes(content.replace(struct.pack("<d", self.rows.distance[1]),
                                              struct.pack("<d", 16 * self.rows.distance[1])))
        self.assertNotEqual(self.file.read_bytes(), content)

    def test_every_reader_notices_a_changed_number(self):
        self.multiply_a_distance()
        before = self.snapshot()
        for name, *arguments in READERS:
            with self.subTest(program=name, arguments=arguments):
                done = self.run_program(name, *arguments)
                self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                self.assertIn("row 1 (task 1) is not as it was written", done.stderr)
                self.assertEqual(done.stdout, "")
        self.assertEqual({name: content
                          for name, content in self.snapshot().items() if not name.endswith(".journal")}, before)
        verified = self.run_program("clogsweep", "verify", "s.h5")
        self.assertEqual(verified.returncode, 1)
        self.assertIn("row 1 (task 1) is not as it was written\ns.h5: 5 undamaged rows, 1 fault\n", verified.stdout)
        with self.assertRaises(stored.Damaged):
            stored.read_rows(self.file)
        # HDF5's own checksum of the table's chunks protects readers that do not know our checksums.
        with self.assertRaises(OSError), h5py.File(self.file) as file:
            file["runs"][:]
        with pandas.HDFStore(self.file, "r") as store, self.assertRaisesRegex(Exception, "read"):
            store["runs"]

    def test_what_is_whole_is_salvaged_and_the_sweep_goes_on(self):
        shutil.copy(self.file, self.folder / "undamaged.h5")
        self.multiply_a_distance()
        self.refuse("clogsweep", "salvage", "s.h5", "--output", "s.h5", words=["will not overwrite s.h5"])
        done = self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5")
        self.assertIn("row 1 (task 1)", done.stdout)
        self.assertEqual(len(table(self.folder / "whole.h5")), 5)
        self.succeed("clogsweep", *SETTINGS[:-1], "whole.h5")
        for name in ("whole.h5", "undamaged.h5"):
            self.succeed("clogsweep", "verify", name)
        again, before = (table(self.folder / name).drop(columns=["wall_seconds", "processor_seconds", "rank", "host"])
                         for name in ("whole.h5", "undamaged.h5"))
        pandas.testing.assert_frame_equal(again, before, check_exact=True)

    def test_a_sweep_resumes_whichever_attribute_was_damaged(self):
        undamaged = self.file.read_bytes()
        with h5py.File(self.file) as file:
            texts = {name: file.attrs[name] for name in file.attrs}
        self.assertLessEqual({"kind", "format_version", "config", "checksums"}, set(texts))
        for name, text in texts.items():
            encoded = text if isinstance(text, bytes) else text.encode()
            if not encoded:
                continue
            with self.subTest(attribute=name), h5py.File(self.file, "r+") as file:
                flipped = bytearray(encoded)
                flipped[len(encoded) // 2] ^= 1
                file.attrs.modify(name, bytes(flipped))
            with self.subTest(attribute=name):
                self.assertIn("is not as it was written",
                              self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5").stdout)
                self.assertEqual(len(table(self.folder / "whole.h5")), 6)
                self.succeed("clogsweep", "verify", "whole.h5")
                self.succeed("clogsweep", *SETTINGS[:-1], "whole.h5")
                self.assertIn("6 rows of 6 runs, all undamaged", self.succeed("clogsweep", "verify", "whole.h5").stdout)
                pandas.testing.assert_frame_equal(table(self.folder / "whole.h5"), self.rows)
            (self.folder / "whole.h5").unlink(missing_ok=True)
            self.file.write_bytes(undamaged)

    def test_every_reader_notices_a_word_that_no_column_can_hold(self):
        undamaged = self.file.read_bytes()
        for column in ("mechanism", "status", "clogged_by", "gravity"):
            stored_rows.change(self.file, lambda rows, column=column: rows[column].__setitem__(1, b"wrapqed"))
            for name, *arguments in READERS:
                with self.subTest(column=column, program=name, arguments=arguments):
                    self.refuse(name, *arguments,
                                words=[f"row 1 (task 1): {column}='wrapqed' is unknown", "clogsweep salvage"])
            self.assertEqual(self.run_program("clogsweep", "verify", "s.h5").returncode, 1)
            self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5")
            pandas.testing.assert_frame_equal(table(self.folder / "whole.h5"),
                                              self.rows.drop(index=1).reset_index(drop=True))
            (self.folder / "whole.h5").unlink()
            self.file.write_bytes(undamaged)

    def test_a_preset_of_another_version_is_no_damage(self):
        stored_rows.change_columns(self.file, preset=b"viscous")
        self.assertIn("all undamaged", self.succeed("clogsweep", "verify", "s.h5").stdout)
        self.assertIn("preset=viscous", self.succeed("clogfit", "s.h5").stdout)

    def test_what_verify_refuses_is_not_salvaged(self):
        """A file from elsewhere may match its checksums and still contain impossible values."""
        def repeat_a_run(rows):
            rows[2] = rows[1]
            rows["task"][2] = 2

        undamaged = self.file.read_bytes()
        for edit, number, words in [(lambda path: stored_rows.change(path, repeat_a_run),
                                     5, "task 2: the same run as task 1"),
                                    (lambda path: stored_rows.change_columns(path, wall_seconds=-1),
                                     0, "task 0: wall_seconds=-1 is no time"),
                                    (lambda path: stored_rows.change_attribute(path, "config", "line-tension = many\n"),
                                     6, "its attribute config")]:
            with self.subTest(words):
                edit(self.file)
                self.assertNotEqual(self.run_program("clogsweep", "verify", "s.h5").returncode, 0)
                self.assertIn(words, self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5").stdout)
                self.succeed("clogsweep", "verify", "whole.h5")
                self.assertEqual(len(table(self.folder / "whole.h5")), number)
            (self.folder / "whole.h5").unlink(missing_ok=True)
            self.file.write_bytes(undamaged)

    def test_a_salvaged_file_without_config_is_not_taken_over_by_another_sweep(self):
        with h5py.File(self.file, "r+") as file:
            file.attrs.modify("config", "line-tension = 3\n")
        self.succeed("clogsweep", "salvage", "s.h5", "--output", "whole.h5")
        self.refuse("clogsweep", *[word.replace("=60", "=70") for word in SETTINGS[:-1]], "whole.h5",
                    words=["other settings: max-time=70 (file: 60)"])

    def prints_once(self, words, *command):
        self.assertEqual(self.succeed(*command).stderr.count(words), 1, command)

    def test_a_journal_that_cannot_be_read_is_named(self):
        self.write("s.h5.journal", "a journal of another version")
        for command in (["clogfit", "s.h5"], ["clogsweep", "replay", "s.h5", 0], ["clogsweep", "status", "s.h5"]):
            self.prints_once("s.h5: runs that only its journal has are missing here: cannot read ", *command)

    def test_settings_of_another_version_are_named(self):
        shutil.copyfile(self.file, self.folder / "other.h5")
        stored_rows.change_attribute(self.file, "config", "viscosity = 3\n")
        self.prints_once("the lists of the stored settings are unknown here: unknown key", "clogfit", "s.h5", "--format", "json")
        self.prints_once("s.h5, other.h5: read together without their settings: cannot read s.h5 (its attribute config: ", "clogfit", "s.h5", "other.h5")

    def test_rows_that_no_settings_describe_are_counted(self):
        stored_rows.change_columns(self.file, preset=b"viscous")
        stored_rows.change_attribute(self.file, "config", "line-tension = 3\n")
        self.prints_once("s.h5: no settings of this version describe 6 runs; the rows are kept\n", "clogsweep", "select", "s.h5", "seed>=1", "--output", "part.h5")
        self.assertEqual(len(table(self.folder / "part.h5")), 6)

    def test_copies_by_other_programs_are_read_with_a_warning(self):
        with h5py.File(self.file) as file, h5py.File(self.folder / "copy.h5", "w") as copy:
            file.copy("runs", copy)
            file.copy("row_checksums", copy)
            copy.attrs.update(file.attrs)
            rows = file["runs"][:]
            copy.create_dataset("packed", data=rows, compression="gzip", chunks=(4,))
            copy["packed"].attrs.update(file["runs"].attrs)
            del copy["runs"]
            copy.move("packed", "runs")
        for name, *arguments in [("clogsweep", "status", "copy.h5"), ("clogfit", "copy.h5")]:
            self.assertIn("copied or changed by another program", self.succeed(name, *arguments).stderr)
        self.assertIn("copied or changed by another program", self.succeed("clogsweep", "verify", "copy.h5").stdout)
        self.assertEqual(stored.read_rows(self.folder / "copy.h5").tobytes(), rows.tobytes())
        with h5py.File(self.folder / "copy.h5", "r+") as copy:
            rows["distance"][2] *= 16
            copy["runs"][:] = rows
        with self.assertRaisesRegex(stored.Damaged, "row 2 .task 2."):
            stored.read_rows(self.folder / "copy.h5")
        self.refuse("clogfit", "copy.h5", words=["row 2 (task 2)"])

    def copied(self):
        """Copies the file as another program would. The copy has all content, but no seal."""
        content = self.file.read_bytes()
        copy = self.folder / "copy.h5"
        copy.write_bytes(content[:content.rindex(b"\nclogsweep seal")])
        return copy

    def test_verify_tells_when_only_other_readers_refuse_a_copy(self):
        """Our checksums cover only rows and attributes. The checksum that HDF5 stores for a chunk covers its padding,
        too, so other readers refuse a copy with damaged padding."""
        copy = self.copied()
        whole = copy.read_bytes()
        with h5py.File(copy) as file:
            chunks = {name: file[name].id.get_chunk_info(0) for name in ("runs", "row_checksums")}
            num_rows, row_size = len(file["runs"]), file["runs"].dtype.itemsize
        self.assertIn("all undamaged", self.succeed("clogsweep", "verify", "copy.h5").stdout)
        # Offsets of the last bytes of the checksums of the chunks.
        last = {name: chunk.byte_offset + chunk.size - 1 for name, chunk in chunks.items()}
        for place in (*last.values(), chunks["runs"].byte_offset + num_rows * row_size):
            content = bytearray(whole)
            content[place] ^= 1
            copy.write_bytes(content)
            with self.subTest(place=place):
                with h5py.File(copy) as file, self.assertRaises(OSError):
                    [file[name][:] for name in chunks]
                verified = self.run_program("clogsweep", "verify", "copy.h5")
                self.assertEqual(verified.returncode, 1)
                self.assertIn("h5py, pandas and other readers refuse the file; `clogsweep salvage` writes a file",
                              verified.stdout)
                self.succeed("clogsweep", "salvage", "copy.h5", "--output", "whole.h5")
                pandas.testing.assert_frame_equal(table(self.folder / "whole.h5"), self.rows)
                (self.folder / "whole.h5").unlink()

    def test_python_does_not_read_a_copy_whose_description_is_damaged(self):
        """Our checksums cover the bytes of rows, but not the names, types and positions of columns. If these are
        damaged, the same bytes mean other numbers."""
        copy = self.copied()
        whole = copy.read_bytes()
        self.assertEqual(len(clogsweep.open(copy).rows), 6)
        begin = whole.index(b"distance\0")
        refused = 0
        for place in range(begin, begin + 60):
            content = bytearray(whole)
            content[place] ^= 1 << place % 7
            copy.write_bytes(content)
            with self.subTest(place=place - begin), contextlib.redirect_stderr(io.StringIO()):
                if self.run_program("clogsweep", "status", "copy.h5").returncode == 0:
                    pandas.testing.assert_frame_equal(clogsweep.open(copy).rows, clogsweep.open(self.file).rows)
                else:
                    refused += 1
                    with self.assertRaises(clogsweep.UserError):
                        clogsweep.open(copy)
        self.assertGreater(refused, 15)

    def test_the_check_of_a_copy_is_not_reused_for_a_changed_copy(self):
        """The result of the check was once cached by the name and the time of the file, and a changed copy with the
        same time counted as undamaged."""
        copy = self.copied()
        clogsweep.open(copy)
        content = copy.read_bytes()
        times = copy.stat()
        copy.write_bytes(content.replace(b"distance\0", b"eistance\0"))
        os.utime(copy, ns=(times.st_atime_ns, times.st_mtime_ns))
        with self.assertRaises(clogsweep.Damaged):
            clogsweep.open(copy)

    def test_python_refuses_an_unsealed_run(self):
        self.succeed("clogrun", "array", *QUICK, "seeds=1", "--output", "r.h5", "--polygon-interval", 5)
        run = self.folder / "r.h5"
        content = run.read_bytes()
        run.write_bytes(content[:content.rindex(b"\nclogsweep seal")])
        with self.assertRaisesRegex(clogsweep.UserError, "cannot trust .*r.h5 .another program copied or changed it"):
            clogsweep.open(run)

    def test_little_memory_is_no_damage_and_no_crash(self):
        """HDF5 and Open MPI crash if memory is short. When HDF5 could not load an intact file, the file was once
        reported as damaged."""
        if not may_limit_memory():
            self.skipTest("programs with sanitizers map more memory than any machine has")
        sweep = [*SETTINGS[:-1], "new.h5"]
        printed = []

        def run_with(size, name, arguments):
            return subprocess.run([BIN / name, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                  preexec_fn=lambda: limit_memory(size))

        for megabytes in [*range(30, 100, 6), 128, 200, 300, 450, 600]:
            for name, *arguments in [("clogfit", "s.h5"), ("clogsweep", "verify", "s.h5"), ("clogsweep", *sweep)]:
                size = megabytes * 2**20
                done = run_with(size, name, arguments)
                # If less than 150 kB of memory are left after the libraries are loaded, one of them (Highway) ends the
                # process before main().
                if done.returncode == -signal.SIGABRT and run_with(size - 2**18, name, arguments).returncode == 127:
                    continue
                with self.subTest(program=name, arguments=arguments[:1], megabytes=megabytes):
                    # The code is 127 if the libraries do not fit into memory.
                    self.assertIn(done.returncode, (0, 2, 127), done.stderr)
                    self.assertNotIn("damaged", done.stderr)
                printed.append((done.returncode, "out of memory" in done.stderr))
        self.assertIn((2, True), printed)
        self.assertIn((0, False), printed)

    def test_copies_of_h5repack_are_read(self):
        subprocess.run(["h5repack", "-f", "GZIP=6", self.file, self.folder / "packed.h5"], check=True)
        said = self.succeed("clogfit", "packed.h5")
        self.assertIn("copied or changed by another program", said.stderr)
        self.assertEqual(said.stdout, self.succeed("clogfit", "s.h5").stdout)
        pandas.testing.assert_frame_equal(clogsweep.open(self.folder / "packed.h5").rows,
                                          clogsweep.open(self.file).rows)
        self.assertIn("copied or changed by another program",
                      self.succeed("clogsweep", *SETTINGS[:-1], "packed.h5").stderr)
        self.assertIs(stored.is_sealed(self.folder / "packed.h5"), True, "the sweep has written it anew")
        pandas.testing.assert_frame_equal(table(self.folder / "packed.h5"), self.rows)

    def test_a_table_of_another_description_is_not_read(self):
        """The description of the table is compared before any row is read."""
        def put(file, rows, **options):
            meanings = dict(file["runs"].attrs)
            del file["runs"]
            file.create_dataset("runs", data=rows, **options)
            file["runs"].attrs.update(meanings)

        def retyped(file):
            rows = file["runs"][:]
            return rows.astype([(name, "<f4" if name == "distance" else rows.dtype[name]) for name in rows.dtype.names])

        def enlarged(file):
            file["runs"].resize((10**7,))

        for words, harm in {
            "its table has another shape": lambda file: put(file, file["runs"][:].reshape(2, 3)),
            "its columns are not those that were written": lambda file: put(file, retyped(file)),
            "its columns are not": lambda file: put(file, file["runs"][:][list(file["runs"].dtype.names)[:-1]]),
            "its table cannot hold 10000000 rows": enlarged,
            "the rows' checksums are not those of its 5 rows": lambda file: put(file, file["runs"][:5]),
            "the rows' checksums are gone": lambda file: file.move("row_checksums", "sums"),
        }.items():
            copy = self.copied()
            with h5py.File(copy, "r+") as file:
                harm(file)
            with self.subTest(words):
                self.refuse("clogsweep", "status", "copy.h5", words=["copy.h5", "damaged", words])
                with self.assertRaises(clogsweep.UserError):
                    stored.read_rows(copy)

    def test_files_of_other_formats_get_one_line(self):
        for version in ("4", "8", "99"):
            stored_rows.make_older(self.file, version)
            before = self.file.read_bytes()
            line = f"(format version {version}, this program reads 9 to 12); use the program that wrote it, or compute the rows anew"
            for name, *arguments in [*READERS, ("clogsweep", "verify", "s.h5")]:
                self.refuse(name, *arguments, words=["s.h5", line])
            with self.assertRaisesRegex(clogsweep.UserError, re.escape(line)):
                clogsweep.open(self.file)
            self.assertEqual(self.file.read_bytes(), before)

    def test_a_column_offset_beyond_the_row_is_refused(self):
        """The description of the table contains the offset of each column. With a wrong offset, memory outside the row
        was once shown as a value."""
        content = bytearray(self.file.read_bytes()[:-stored.SEAL_SIZE])
        name = content.index(b"kinetic_energy_ratio\0")
        offset = name + 24  # Names are padded to eight bytes, and the offset of the column follows.
        self.assertLess(struct.unpack_from("<I", content, offset)[0], 2000)
        struct.pack_into("<I", content, offset, 60000)
        self.file.write_bytes(content)
        for name, *arguments in [*READERS, ("clogsweep", "verify", "s.h5")]:
            self.refuse(name, *arguments, words=["damaged"])

    def test_a_full_disk_ends_with_exit_code_2(self):
        def limit():
            # At this limit the system sends SIGXFSZ, which ends a program that does not ignore it.
            resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

        for name, *arguments in [("clogsweep", *SETTINGS[:-1], "new.h5"),
                                 ("clogrun", "array", *QUICK, "seeds=1", "--output", "run.h5")]:
            # Without these settings, the limit would also affect a daemon of Open MPI and the shared memory of MPICH.
            done = subprocess.run([BIN / name, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                  preexec_fn=limit,
                                  env={**os.environ, "OMPI_MCA_ess_singleton_isolated": "1", "UCX_TLS": "self,tcp"})
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("File too large", done.stderr)


if __name__ == "__main__":
    unittest.main()
