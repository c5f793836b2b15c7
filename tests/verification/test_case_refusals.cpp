// What the program answers to input that only shows its fault when put to use: one line, a status, nothing written.
#include <gtest/gtest.h>

#include "support/case_run.hpp"

namespace eg::test {
namespace {

struct Answer {
  int status = 0;
  std::string text;  ///< of standard error
};

class Refusals : public ::testing::Test {
 protected:
  Refusals() : folder_(std::filesystem::temp_directory_path() / ("eigengrain_refusals_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Refusals() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  /// A scene of which some lines are given: G on line 3, the specimen from line 10.
  std::string scene(const std::string& modulus, const std::string& specimen) const {
    return write(
        "s.toml",
        "dimension = 3\n[material.quartz]\nshear_modulus = " + modulus +
            "\npoisson = 0.12\ndensity = 2650\nfriction = 0.3\n[contact]\nlaw = \"hertz-mindlin\"\n[specimen]\n" +
            specimen +
            "\n[boundary]\ntype = \"periodic\"\n[[stage]]\nname = \"press\"\nstress = { isotropic = 100e3 }\n"
            "until = { stress_error = 1e-2 }\n");
  }

  Answer ask(const std::string& arguments) const {
    const std::string command = std::string(EIGENGRAIN_PROGRAM) + " " + arguments + " 2>&1 >/dev/null";
    std::FILE* pipe = popen(command.c_str(), "r");
    Answer answer;
    std::array<char, 4096> part{};
    while (const auto n = std::fread(part.data(), 1, part.size(), pipe)) answer.text.append(part.data(), n);
    answer.status = WEXITSTATUS(pclose(pipe));
    return answer;
  }
  void expect_line(const std::string& arguments, const std::string& line) const {
    const Answer answer = ask(arguments);
    EXPECT_EQ(answer.status, 2) << arguments;
    EXPECT_EQ(answer.text, line + "\n") << arguments;
  }

  std::filesystem::path folder_;
};

const std::string cloud = "source = \"cloud\"\ncount = 100\ngrading = { radius = 1e-3 }";

TEST_F(Refusals, ModulusInGigapascal) {
  const std::string path = scene("29", cloud), out = file("out");
  expect_line("run " + path + " --out " + out,
              path +
                  ":3: material.quartz.shear_modulus = 29 is too soft: grains would overlap by more than 30 % of "
                  "their diameter under the 100000 Pa of stage \"press\"; give it in Pa (quartz: 29e9), and "
                  "stresses too");
}

TEST_F(Refusals, SpecimenThatCannotBeMade) {
  const std::string path = scene("29e9", "source = \"file\"\npath = \"grains.txt\"");
  expect_line("run " + path + " --out " + file("out"),
              path +
                  ":11: specimen.path = \"grains.txt\" names a file that is not there; paths start from the folder "
                  "of the scene");
  const std::string full = scene("29e9", cloud + "\nsolid_fraction = 0.69");
  const Answer answer = ask("run " + full + " --out " + file("out"));
  EXPECT_EQ(answer.status, 2);
  EXPECT_TRUE(answer.text.starts_with(full + ":9: specimen: cloud of 100 grains: solid fraction 0.69")) << answer.text;
}

TEST_F(Refusals, MeshesThatAreNoWalls) {
  const std::string path = write("m.toml",
                                 "dimension = 3\n[material.a]\nshear_modulus = 29e9\npoisson = 0.12\ndensity = 2650\n"
                                 "friction = 0.3\n[contact]\nlaw = \"hertz-mindlin\"\n[specimen]\n" +
                                     cloud +
                                     "\n[boundary]\ntype = \"free\"\n[[boundary.mesh]]\nname = \"cone\"\n"
                                     "file = \"cone.stl\"\n[[stage]]\nname = \"fall\"\nuntil = { steps = 1 }\n");
  const std::string stl = file("cone.stl"), where = path + ":17: boundary.mesh[1].file = \"cone.stl\" ";
  const auto expect = [&](const std::string& fault) {
    expect_line("run " + path + " --out " + file("out"), where + fault);
    EXPECT_FALSE(std::filesystem::exists(file("out")));
  };
  expect("names a file that is not there; paths start from the folder of the scene");

  const std::string wall = "cannot be a wall: " + stl + ": ";
  const std::string again = "; export the mesh again, as binary or ASCII STL";
  write("cone.stl", "o cone\nv 0 0 0\n");  // another format of meshes
  expect(wall + "is no STL file: it is neither ASCII nor of the length its facets need" + again);
  write("cone.stl", "solid cone\nendsolid cone\n");
  expect(wall + "is no STL file: it holds no facets" + again);

  // three sides of a tetrahedron
  std::string sides = "solid cone\n";
  for (const char* corners : {"0 0 0 0 1 0 1 0 0", "0 0 0 1 0 0 0 0 1", "0 0 0 0 0 1 0 1 0"}) {
    std::istringstream in(corners);
    for (std::string x, y, z; in >> x >> y >> z;) sides += "vertex " + x + " " + y + " " + z + "\n";
  }
  write("cone.stl", sides + "endsolid cone\n");
  expect(wall + "facet 1 has an edge without a neighbour: the mesh has a hole; close it, or say open = true");
  EXPECT_EQ(ask("info " + path + " --set boundary.mesh[1].open=true").status, 0);
}

TEST_F(Refusals, OptionsMisspelt) {
  expect_line("run --thread 2",
              "eigengrain: The following argument was not expected: --thread; did you mean \"--threads\"?; "
              "`eigengrain run --help` lists what there is");
  const Answer answer = ask("measure x.h5 --plot rose");
  EXPECT_EQ(answer.status, 2);
  EXPECT_NE(answer.text.find("--plot requires --figure"), std::string::npos) << answer.text;
}

TEST_F(Refusals, SubcommandsMisspelt) {
  expect_line("rn x.toml", "eigengrain: rn is not a subcommand; did you mean \"run\"?");
  expect_line("waves disp x.toml", "eigengrain waves: disp is not a subcommand; did you mean \"dispersion\"?");
  expect_line("waves transmit x.toml",
              "eigengrain: --frequency is required; `eigengrain waves transmit --help` lists what there is");
}

TEST_F(Refusals, NumbersThatAreNone) {
  const std::string rest = ", without a unit; `eigengrain measure --help` lists what there is";
  for (const std::string word : {"nan", "inf", "1e-3m", "x"})
    for (const std::string option : {"--sphere", "--split", "--gauge", "--shear-modulus"})
      expect_line("measure x.h5 " + option + " " + word,
                  "eigengrain: " + option + ": value " + word + " must be a finite number" + rest);
}

TEST_F(Refusals, OptionsThatWouldBeLost) {
  const std::string lattice = case_file("lattice_fcc"), snapshot = write("empty.h5", "");
  expect_line("timestep " + snapshot,
              snapshot + ": this is no snapshot in spite of its name; take a file that a run has written");
  expect_line("timestep " + snapshot + " --solver slepc --verify",
              "eigengrain timestep: --solver slepc has no --verify; leave it out, or take --solver own");
  const std::string history = write("history.csv", "step [-],time [s]\n1,1\n");
  expect_line("plot " + history + " --y time",
              "eigengrain plot: nothing to make of these columns; add --figure FILE, --json or --mean-over");
  expect_line("plot " + history + " --y time --json --label a,b",
              "eigengrain plot: --label names 2 histories of 1; give one name each");
  expect_line("measure " + lattice + " --initial --json --zones x:10000,y:10000,z:1000",
              "1e+11 zones to measure are more than 3e+07; make them larger");
}

}  // namespace
}  // namespace eg::test
