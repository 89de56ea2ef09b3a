#include "clog/sweep/settings.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "clog/core/run/resolve.hpp"
#include "clog/core/tools/error.hpp"
#include "clog/sweep/keys.hpp"
#include "clog/sweep/plan.hpp"

namespace clog::sweep {
namespace {

std::string refusal(const std::string& name, const std::string& text) {
  try {
    Settings().set(name, text);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Settings, DefaultsAreThoseOfTheParameters) {
  const Settings settings;
  const RunParameters expected;
  for (const Key& key : keys()) {
    if (!key.parameter) continue;
    RunParameters run;
    key.apply(run, settings.values(key.name).front());
    EXPECT_EQ(key.parameter->get(run), key.parameter->get(expected)) << key.name;
  }
}

/// A preset sets perimeter-stiffness-ratio. The config must not contain the preset's ratio if the user chose
/// other springs or gave a stiffness.
TEST(Settings, AreReadBackForEveryPresetWithOtherSprings) {
  for (const std::string& preset : preset_names())
    for (const auto& [key, text] : {std::pair{"perimeter-spring", "mean"},
                                    {"perimeter-spring", "rest"},
                                    {"perimeter-spring", "along"},
                                    {"perimeter-stiffness", "0.5"}}) {
      Settings settings;
      settings.set("preset", preset);
      settings.set(key, text);
      if (std::string_view(text) == "along") settings.set("gravity", "area");
      const RunParameters run = Plan(settings).task(0);
      const RunParameters again = Plan(Settings::from_config(settings.to_config())).task(0);
      EXPECT_EQ(again.dp.perimeter_stiffness, run.dp.perimeter_stiffness)
          << preset << " " << key << " " << text;
    }
}

TEST(Settings, ReadBackFromTheirOwnText) {
  Settings settings;
  settings.set("line-tension", "log(0.1,10,3)");
  settings.set("seeds", "4..9");
  settings.set("model", "dp");
  for (const Comments comments : {Comments::none, Comments::help}) {
    const Settings again = Settings::from_config(settings.to_config(comments));
    EXPECT_EQ(again.to_config(), settings.to_config());
    EXPECT_EQ(again.values("line-tension"), (std::vector<std::string>{"0.1", "1", "10"}));
  }
}

TEST(Settings, ValuesStayWhereTheyAreWhileOtherKeysAreSet) {
  Settings settings;
  const std::vector<std::string>& models = settings.values("model");
  const void* const place = models.data();
  settings.set("line-tension", "0.1,0.2");
  EXPECT_EQ(settings.values("line-tension").size(), 2);
  EXPECT_EQ(settings.values("model").data(), place);
}

TEST(Settings, RefuseWhatTheyCannotRead) {
  EXPECT_NE(refusal("line-tenson", "1").find("did you mean line-tension"), std::string::npos);
  EXPECT_NE(refusal("temperature", "1").find("unknown key 'temperature'"), std::string::npos);
  EXPECT_NE(refusal("line-tension", "soft").find("invalid line-tension=soft ('soft' is not a finite number)"),
            std::string::npos);
  EXPECT_NE(refusal("model", "sph").find("not one of dp, sp"), std::string::npos);
  EXPECT_NE(refusal("seeds", "-1").find("out of range"), std::string::npos);
  EXPECT_NE(refusal("seeds", "5000000000").find("out of range"), std::string::npos);
}

TEST(Settings, SayInWhichUnitANumberIs) {
  EXPECT_EQ(
      refusal("obstacle-gap", "0.3mm"),
      "invalid obstacle-gap=0.3mm ('0.3mm' is not a finite number; numbers have no unit here: this one is "
      "in sigma)");
  EXPECT_NE(refusal("obstacle-gap", "lin(0.2,0.3 sigma,3)").find("this one is in sigma"), std::string::npos);
  EXPECT_NE(refusal("receding-angle", "90\u00b0").find("this one is in degrees"), std::string::npos);
  EXPECT_NE(refusal("friction", "5%").find("this one is a pure number"), std::string::npos);
  EXPECT_NE(refusal("vertices", "2k").find("this one is a pure number"), std::string::npos);
  for (const char* other : {"soft", "0.1..0.5", "1,,2", "2,2", "inf", "1e999", "1.2.3", "lin(1,2)"})
    EXPECT_EQ(refusal("line-tension", other).find("unit"), std::string::npos) << other;
  EXPECT_EQ(refusal("model", "2d").find("unit"), std::string::npos);
}

TEST(Settings, APresetSetsTheKeysThatWereNotGiven) {
  Settings settings;
  settings.set("gravity", "area");
  settings.set("preset", "literal");
  EXPECT_EQ(settings.text("perimeter-spring"), "rest");
  EXPECT_EQ(settings.text("wall-contact"), "vertex");
  EXPECT_EQ(settings.text("self-contact"), "off");
  EXPECT_EQ(settings.text("gravity"), "area") << "given by hand before the preset";
  settings.set("wall-contact", "edge");
  settings.set("preset", "elastic");
  EXPECT_EQ(settings.text("wall-contact"), "edge");
  EXPECT_EQ(settings.text("perimeter-stiffness-ratio"), "0.1");
  EXPECT_EQ(Settings::from_config(settings.to_config(Comments::help)).to_config(), settings.to_config());
}

TEST(Settings, AGivenKeyDecidesInWhateverOrder) {
  Settings one, other;
  one.set("obstacle-layout", "channel");
  EXPECT_EQ(one.text("seeds"), "1") << "nothing is random";
  one.set("obstacle-layout", "random");
  EXPECT_EQ(one.text("seeds"), find_key("seeds").default_text);
  one.set("release", "anywhere");
  one.set("obstacles", "c.csv");
  other.set("obstacles", "c.csv");
  EXPECT_EQ(other.text("seeds"), "1") << "the droplet starts at the centre";
  EXPECT_EQ(other.text("obstacle-layout"), "file");
  other.set("release", "anywhere");
  other.set("obstacle-layout", "random");
  EXPECT_EQ(one.to_config(), other.to_config());
  EXPECT_EQ(one.text("seeds"), find_key("seeds").default_text);
}

TEST(Settings, ReadBackPointsInSeveralScenes) {
  Settings settings;
  settings.attach("c.csv", OwnCircles({{5, 5, 0.3}}));
  settings.set_points({{"obstacles", "orifice"}, {{"c.csv", ""}, {"", "0.6"}, {"", ""}}});
  const Settings again = Settings::from_config(settings.to_config());
  for (const Settings& one : {settings, again}) {
    std::vector<std::string> layouts;
    one.visit_branches([&](const Settings& branch, std::int64_t) {
      layouts.push_back(branch.text("obstacle-layout") + ' ' + branch.text("seeds"));
    });
    EXPECT_EQ(layouts, (std::vector<std::string>{"file 1", "channel 1", "random 1..10"}));
  }
}

TEST(PresetName, IsFoundFromTheValuesUsed) {
  for (const char* name : {"robust", "heavy-interface", "elastic", "literal"}) {
    Settings settings;
    settings.set("preset", name);
    RunParameters run;
    for (const Key& key : keys()) key.apply(run, settings.values(key.name).front());
    EXPECT_EQ(preset_name(resolve(run)), name);
    run.dp.self_contact = run.dp.self_contact == SelfContact::on ? SelfContact::off : SelfContact::on;
    EXPECT_EQ(preset_name(resolve(run)), "custom");
  }
}

TEST(Settings, RefuseAConfigWithALineThatIsNone) {
  EXPECT_THROW(Settings::from_config("line-tension - 3\n"), Error);
  EXPECT_EQ(Settings::from_config("\n# a comment\nline-tension = 3\n").text("line-tension"), "3");
}

TEST(Settings, ReadBackNamesOfFilesWithAnyByte) {
  constexpr int num_bytes = 256;
  for (int byte = 0; byte < num_bytes; ++byte) {
    const std::string one(1, static_cast<char>(byte));
    for (const std::string& text : {one, one + "p.csv", "p" + one + ".csv", "p.csv" + one, "\\x" + one + "0a",
                                    "p.csv" + one + "line-tension = 0.1", one + one + "#circles " + one}) {
      EXPECT_EQ(unescaped(escaped(text)), text) << byte;
      EXPECT_EQ(escaped(text).find_first_of(std::string_view("\n\r\0#", 4)), std::string::npos) << byte;
      Settings settings;
      // Such texts are not lists of files.
      if (one == "," || text.find_first_not_of(" \t") == std::string::npos) continue;
      settings.set("obstacles", text);
      const std::string file = settings.values("obstacles").front();
      settings.attach(file, OwnCircles({{5, 5, 0.3}}));
      for (const Comments comments : {Comments::none, Comments::help})
        EXPECT_EQ(Settings::from_config(settings.to_config(comments)).text("obstacles"), text) << byte;
      const Settings again = Settings::from_packed(settings.packed());
      EXPECT_EQ(again.text("obstacles"), text) << byte;
      EXPECT_EQ(again.text("line-tension"), settings.text("line-tension")) << byte;
      EXPECT_TRUE(again.missing_files().empty()) << byte;
      EXPECT_TRUE(again.circle_files().contains(file)) << byte;
    }
  }
}

TEST(Settings, LeaveABackslashThatEscapesNothing) {
  for (const char* text : {"\\", "a\\b.csv", "\\x", "\\x1", "\\xg0", "\\x-1", "\\x 1"})
    EXPECT_EQ(unescaped(text), text);
  EXPECT_EQ(unescaped("a\\x5cx41"), "a\\x41");
}

}  // namespace
}  // namespace clog::sweep
