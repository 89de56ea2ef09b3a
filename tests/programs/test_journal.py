"""Tests figures for a journal, and files that contain the rows of a sweep for other programs."""

import itertools

import h5py
import numpy as np
import pandas
from matplotlib import image

from drawing import Analysis
from support import BIN, FEW, QUICK, SMALL, shared_sweep, table

import clogsweep
from clogsweep.drawing import device_plan, way
from clogsweep.reading import stored, trajectory

GAPS = [*QUICK, "line-tension=0.1,0.2,0.25,0.3,0.5,3", "obstacle-gap=0.3,0.4", "seeds=1..3"]
MANY = [*QUICK, "line-tension=2,8", "obstacle-gap=lin(0.2,0.35,4)", "obstacle-diameter=lin(0.3,0.45,4)", "seeds=1"]


class Journal(Analysis):
    def fit(self, *keys):
        self.write("lab.cfg", "diameter = 3.5 mm\nangle = 28 deg\ntension = 9.6 mN/m\nspeed = 7 mm/s\n")
        return clogsweep.open(shared_sweep(*keys), BIN).fit(lab=self.folder / "lab.cfg")

    def assert_tidy(self, picture):
        """Checks that the labels of ticks and axes and the words of the legend are on the page. No word may cover
        another."""
        axes, = picture.figure.axes
        picture.figure.canvas.draw()
        texts = list(axes.get_legend().get_texts())
        for axis in (axis for one in (axes, *axes.child_axes) for axis in (one.xaxis, one.yaxis)):
            low, high = sorted(axis.get_view_interval())
            labels = [*axis.get_majorticklabels(), *axis.get_minorticklabels()]
            texts += [axis.label, *(label for label in labels if low <= label.get_position()[axis.axis_name == "y"] <= high)]
        boxes = {text: text.get_window_extent() for text in texts if text.get_text()}
        for (one, box), (other, beside) in itertools.combinations(boxes.items(), 2):
            self.assertFalse(box.overlaps(beside), f"{one} {other}")
        for text, box in boxes.items():
            self.assertTrue(box.x0 > -1 and box.y0 > -1 and box.x1 < picture.figure.bbox.x1 + 1 and box.y1 < picture.figure.bbox.y1 + 1, text)
        self.assertEqual({text.get_fontsize() for text in boxes}, {8})

    def test_no_labels_overlap_at_the_width_of_a_column(self):
        for picture in (self.fit(*GAPS).curve(), self.fit(*GAPS).speeds(), self.fit(*MANY).curve()):
            self.assert_tidy(picture.for_journal(8.6))
            self.assertAlmostEqual(picture.figure.get_figwidth() * 2.54, 8.6)
            self.assertRegex(picture.caption, r"per point,\s+preset robust[\s\S]*bars: ")

    def test_own_points_colours_and_ranges_are_drawn(self):
        picture = self.fit(*GAPS).curve()
        axes, = picture.figure.axes
        self.assertEqual(list(picture.curves), [r"obstacle gap $0.3\,\sigma$", r"obstacle gap $0.4\,\sigma$"])
        first, second = picture.curves.values()
        for artist in first:
            artist.set_color("#123456")
        axes.errorbar([0.15], [7], yerr=[2], fmt="k*", label="experiment")
        axes.set_xlim(0.12, 4)
        self.assert_tidy(picture.for_journal(17.8, 9, font_size=8))
        self.assertEqual([text.get_text() for text in axes.get_legend().get_texts()][:3], [*picture.curves, "experiment"])
        self.assertIn("#123456", {line.get_color() for line in axes.get_legend().findobj(lambda artist: hasattr(artist, "get_marker"))})
        self.assertEqual({artist.get_markeredgecolor() for artist in first if hasattr(artist, "get_marker")}, {"#123456"})
        self.assertNotIn("#123456", [artist.get_color() for artist in second if hasattr(artist, "get_marker")])
        picture.save(self.folder / "own")
        self.assertEqual(image.imread(self.folder / "own.png").shape[1], int(17.8 / 2.54 * 600))
        self.assertNotIn(b"/Type3", (self.folder / "own.pdf").read_bytes())

    def test_commands_make_them(self):
        self.copy_sweep("s.h5", *GAPS)
        for command, *options in (["clogging-length"], ["compare", "--by", "obstacle-gap"]):
            printed = self.draw(command, "s.h5", "--width", 8.6, *options, "--programs", BIN).stdout
            self.assertRegex(printed, rf"^s-{command}.png \(and .pdf\)\n[\s\S]*95 % confidence intervals")
        self.refuse_analysis("dwell", "s.h5", "--width", "0", words=["--width", "0", "width in cm"])

    def test_panels_and_strips_make_no_tower(self):
        figures = [device_plan.axes_for(length, width, 6, strip=1.5)[0] for length, width in ((24, 20), (32, 8), (5, 40))]
        run = trajectory.read(shared_sweep("array", *SMALL, "max-time=60", "--polygon-interval", 10, program="clogrun"))
        run.polygons = run.polygons + np.linspace(0, 2000, len(run.times))[:, None, None] * [[1], [0]]
        self.assertLess(max(160 * figure.get_figheight() for figure in [*figures, way.draw(run, 2)]), 2700)

    def test_a_legend_names_the_circles_and_not_what_follows_from_them(self):
        for name, pitch in (("near.csv", 2), ("far.csv", 2.5)):
            self.write(name, "x,y,diameter\n" + "".join(f"{2 + i * pitch},{1 + 2 * j},0.6\n" for i in range(4) for j in range(5)))
            self.succeed("clogsweep", f"obstacles={name}", "box=10", f"length={5 * pitch}", f"exit={5 * pitch}", "side-walls=on", "vertices=64", "max-time=1",
                         "line-tension=0.5,1", "seeds=1", "--output", f"{name}.h5")
        groups = clogsweep.open([self.folder / "near.csv.h5", self.folder / "far.csv.h5"], BIN).fit().known
        self.assertEqual(sorted(label for label, _ in groups.curves()), ["obstacles far.csv", "obstacles near.csv"])


class Exported(Analysis):
    def test_every_column_has_its_values_and_unit(self):
        self.copy_sweep("s.h5", *FEW)
        rows = table(self.folder / "s.h5")
        meanings = clogsweep.open(self.folder / "s.h5", BIN).rows.attrs["meanings"]
        for output in ("rows.csv", "rows.h5"):
            self.assertEqual(self.draw("export", "s.h5", output, "--programs", BIN).stdout, f"{output}\n")
        read = pandas.read_csv(self.folder / "rows.csv", float_precision="round_trip", keep_default_na=False,
                               na_values=[""])
        self.assertEqual(list(read),
                         [f"{name} [{unit}]" if (unit := stored.unit(meanings[name])) else name for name in rows])
        words = {name: "" for name in rows if rows[name].dtype == object}
        pandas.testing.assert_frame_equal(read.set_axis(rows.columns, axis=1).fillna(words), rows, check_dtype=False, check_exact=True)
        with h5py.File(self.folder / "rows.h5") as file:
            self.assertEqual(set(file), set(rows))
            self.assertIn("line-tension=1,3", file.attrs["source"])
            for name in rows:
                np.testing.assert_array_equal(file[name].asstr()[:] if name in words else file[name][:],
                                              rows[name].to_numpy(), name)
                self.assertEqual((file[name].attrs["unit"], file[name].attrs["meaning"]),
                                 (stored.unit(meanings[name]), meanings[name]))

    def test_several_files_are_one_table(self):
        for name, tension in (("a.h5", 1), ("b.h5", 3)):
            self.succeed("clogsweep", *QUICK, f"line-tension={tension}", "seeds=1..2", "--output", name)
        self.draw("export", "a.h5", "b.h5", "rows.csv", "--programs", BIN)
        self.assertEqual(sorted(pandas.read_csv(self.folder / "rows.csv")[["line_tension [g rho sigma^2]", "seed"]].values.tolist()), [[1, 1], [1, 2], [3, 1], [3, 2]])

    def test_what_is_there_stays(self):
        self.copy_sweep("s.h5", *FEW)
        self.write("t.h5", "my own")
        for arguments, words in ((["s.h5", "t.h5"], ["will not overwrite t.h5", "it exists"]), (["s.h5", "rows.txt"], ["rows.txt", "only be .csv or .h5"]),
                                 (["nope.h5", "rows.csv"], ["cannot read nope.h5"])):
            self.refuse_analysis("export", *arguments, "--programs", BIN, words=words)
        self.assertEqual((self.folder / "t.h5").read_text(), "my own")
