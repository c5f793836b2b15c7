// What a user can get wrong, and the line that answers. One table a kind of input; every message is given in full.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "io/hdf5_file.hpp"
#include "io/history.hpp"
#include "io/packing_file.hpp"
#include "io/scene_file.hpp"
#include "io/snapshot.hpp"
#include "io/text_file.hpp"
#include "scratch.hpp"

// On damaged files HDF5 asks for impossible amounts of memory, copes with the refusal, and leaks: the address sanitizer
// must take both calmly.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

namespace {

const std::vector<std::string> good_scene{"dimension = 3",                     // 1
                                          "[material.quartz]",                 // 2
                                          "shear_modulus = 29e9",              // 3
                                          "poisson = 0.12",                    // 4
                                          "density = 2650",                    // 5
                                          "friction = 0.25",                   // 6
                                          "[contact]",                         // 7
                                          "law = \"hertz-mindlin\"",           // 8
                                          "[specimen]",                        // 9
                                          "source = \"cloud\"",                // 10
                                          "count = 100",                       // 11
                                          "grading = { radius = 1e-3 }",       // 12
                                          "[boundary]",                        // 13
                                          "type = \"periodic\"",               // 14
                                          "[timestep]",                        // 15
                                          "policy = \"certified\"",            // 16
                                          "[[stage]]",                         // 17
                                          "name = \"compress\"",               // 18
                                          "stress = { isotropic = 100e3 }",    // 19
                                          "until = { stress_error = 1e-3 }"};  // 20

/// The good scene with other text in the place of one line (0: the whole text).
std::string scene_with(int line, const std::string& text) {
  if (line == 0) return text;
  std::string all;
  for (std::size_t k = 0; k < good_scene.size(); ++k)
    all += (static_cast<int>(k) + 1 == line ? text : good_scene[k]) + "\n";
  return all;
}

/// The message of the error that f throws, or "" when it throws none.
std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const eg::InputError& error) {
    return error.what();
  }
  return "";
}

struct SceneCase {
  int line;
  std::string text, message;
};

const std::vector<SceneCase> scene_cases{
    // the file as a whole
    {0, "", "s.toml: is an empty scene: it holds no keys; see cases/ for examples"},
    {0, "# nothing\n", "s.toml: is an empty scene: it holds no keys; see cases/ for examples"},
    {1, "dimension 3", "s.toml:1: is not valid TOML: Error while parsing key-value pair: expected '=', saw '3'"},
    {5, "poisson = 0.2",
     "s.toml:5: is not valid TOML: Error while parsing key-value pair: cannot redefine existing floating-point "
     "'poisson'"},
    {5, "density = 2650\n\u00b5 = 1",
     "s.toml:6: is not valid TOML: a character beyond ASCII stands outside quotes and comments; put it in double "
     "quotes"},
    {1, "title = \"\"\"a\"\"\"\"\n\u041b = 1",
     "s.toml:2: is not valid TOML: a character beyond ASCII stands outside quotes and comments; put it in double "
     "quotes"},
    {1, "title = '\u00b5'",
     "s.toml:1: is not valid TOML: a character beyond ASCII stands in single quotes; use double quotes"},
    {1, "title = \"\\\u00b5\"",
     "s.toml:1: is not valid TOML: a backslash stands before a character beyond ASCII; write \\\\ for a backslash"},
    {1, "title = \"\xff\"", "s.toml:1: is not valid TOML: the text is not UTF-8; save the file as UTF-8"},
    // keys
    {1, "dimensoin = 3", "s.toml:1: dimensoin is not a known key; did you mean \"dimension\"?"},
    {1, "title = \"x\"", "s.toml:1: dimension is missing; add \"dimension\" to the top of the file"},
    {1, "dimension = 3\nspeed = 1", "s.toml:2: speed is not a known key; did you mean \"seed\"?"},
    {1, "dimension = 3\nqwertyuiop = 1",
     "s.toml:2: qwertyuiop is not a known key; known here: boundary, contact, damping, dimension, gravity, material, "
     "record, rotation, seed, settings, specimen, stage, timestep, title"},
    {7, "[contct]", "s.toml:7: contct is not a known key; did you mean \"contact\"?"},
    {11, "count = 100\ncells = [1, 1, 1]",
     "s.toml:12: specimen.cells is not a known key; known here: aspect, box, coarse_count, count, "
     "expand_to, grading, scale, solid_fraction, source, trim"},
    {20, "until = { stress_eror = 1e-3 }",
     "s.toml:20: stage[1].until.stress_eror is not a known key; did you mean \"stress_error\"?"},
    {20, "", "s.toml:17: stage[1].until is missing; add \"until\" to [[stage]] number 1"},
    // types
    {1, "dimension = \"3\"",
     "s.toml:1: dimension = \"3\" must be a number; write it in SI units, without quotes and without a unit"},
    {1, "dimension = 3\nrotation = \"no\"",
     "s.toml:2: rotation = \"no\" must be true or false; write it without quotes"},
    {1, "dimension = 3\ntitle = 7", "s.toml:2: title = 7 must be a text; put it in quotes"},
    {11, "count = 10.5", "s.toml:11: specimen.count = 10.5 must be a whole number"},
    {5, "density = true", "s.toml:5: material.quartz.density = true must be a number"},
    {8, "law = 1", "s.toml:8: contact.law = 1 must be a text; put it in quotes"},
    {19, "stress = { isotropic = \"100 kPa\" }",
     "s.toml:19: stage[1].stress.isotropic = \"100 kPa\" must be a number; write it in SI units, without quotes and "
     "without a unit"},
    {19, "hold = { combinations = [{ stress = { x = 1 } }] }",
     "s.toml:19: stage[1].hold.combinations[1].value is missing; add \"value\" to [[stage.hold.combinations]] number 1 "
     "of hold of [[stage]] number 1"},
    {19, "hold = { combinations = 3 }",
     "s.toml:19: stage[1].hold.combinations = 3 must be an array of tables; write [[stage.hold.combinations]]"},
    {19, "hold = { combinations = [{ stress = 1, value = 0 }] }",
     "s.toml:19: stage[1].hold.combinations[1].stress = 1 must be a table; write stress = { … }"},
    {19, "bond = {}", "s.toml:19: stage[1].bond.gap is missing; add \"gap\" to bond of [[stage]] number 1"},
    {19, "stress = 100e3", "s.toml:19: stage[1].stress = 100000 must be a table; write stress = { … }"},
    {1, "dimension = 3\ngravity = [0, 0, -9.81]",
     "s.toml:2: gravity has no ground in a cell that is periodic in every direction: grains would fall forever; leave "
     "it out, or set boundary.type to \"box\" or \"free\" with walls"},
    {17, "[stage]", "s.toml:17: stage must be an array of tables; write [[stage]]"},
    {12, "grading = { passing = [[1e-3, 0], 2e-3] }",
     "s.toml:12: specimen.grading.passing[2] = 0.002 must be an array of two numbers"},
    // numbers out of range
    {1, "dimension = 4", "s.toml:1: dimension = 4 must lie in [2, 3]"},
    {1, "dimension = 3\nseed = -1", "s.toml:2: seed = -1 must lie in [0, 9007199254740991]"},
    {1, "dimension = 3\ngravity = [0, -9.81]", "s.toml:2: gravity must hold 3 numbers, not 2"},
    {1, "dimension = 3\ngravity = [0, nan, 0]", "s.toml:2: gravity[2] = nan must be a finite number"},
    {4, "poisson = 0.62", "s.toml:4: material.quartz.poisson = 0.62 must lie in (-1, 0.5)"},
    {4, "poisson = nan", "s.toml:4: material.quartz.poisson = nan must lie in (-1, 0.5)"},
    {3, "shear_modulus = inf", "s.toml:3: material.quartz.shear_modulus = inf must be finite and > 0"},
    {5, "density = 0", "s.toml:5: material.quartz.density = 0 must be finite and > 0"},
    {6, "friction = -0.1", "s.toml:6: material.quartz.friction = -0.1 must be finite and >= 0"},
    {11, "count = 0", "s.toml:11: specimen.count = 0 must lie in [1, 4000000000]"},
    {12, "grading = { radius = -1e-3 }", "s.toml:12: specimen.grading.radius = -0.001 must be finite and > 0"},
    {16, "safety = 1.5", "s.toml:16: timestep.safety = 1.5 must lie in (0, 1]"},
    {16, "policy = \"fixed\"\nfixed = 0", "s.toml:17: timestep.fixed = 0 must be finite and > 0"},
    {15, "[damping]\nlocal = 1\n[timestep]", "s.toml:16: damping.local = 1 must lie in [0, 1)"},
    {19, "stress = { isotropic = 0 }", "s.toml:19: stage[1].stress.isotropic = 0 must be finite and > 0"},
    {20, "until = { steps = 0 }", "s.toml:20: stage[1].until.steps = 0 must lie in [1, 1000000000000000]"},
    // names
    {8, "law = \"hertz-mindlim\"",
     "s.toml:8: contact.law = \"hertz-mindlim\" must be one of \"linear\", "
     "\"linear-incremental\", \"hertz-mindlin\", \"hertz-mindlin-rescale\", \"hertz-mindlin-exponent\", "
     "\"hertz-mindlin-deresiewicz\", \"rough-hertz-mindlin\", \"rough-hertz-mindlin-deresiewicz\", "
     "\"linear-rolling\", \"linear-parallel-bond\"; did you mean \"hertz-mindlin\"?"},
    {10, "source = \"rain\"", "s.toml:10: specimen.source = \"rain\" must be one of \"lattice\", \"cloud\", \"file\""},
    {12, "grading = \"ottawa\"", "s.toml:12: specimen.grading = \"ottawa\" must be one of \"toyoura\""},
    {14, "type = \"wall\"", "s.toml:14: boundary.type = \"wall\" must be one of \"periodic\", \"free\", \"box\""},
    {14, "type = \"box\"\nwall_material = \"glass\"",
     "s.toml:15: boundary.wall_material = \"glass\" must be one of \"quartz\""},
    {16, "policy = \"certfied\"",
     "s.toml:16: timestep.policy = \"certfied\" must be one of \"certified\", \"fixed\", \"estimate:NAME\"; did you "
     "mean "
     "\"certified\"?"},
    {18, "name = \"../up\"", "s.toml:18: stage[1].name = \"../up\" must be made of letters, digits, - and _"},
    {18, "name = \"\"", "s.toml:18: stage[1].name = \"\" must not be empty"},
    // keys that do not go together
    {3, "",
     "s.toml:4: material.quartz.poisson = 0.12 needs shear_modulus beside it for the law \"hertz-mindlin\"; add "
     "shear_modulus"},
    {8, "law = \"linear\"",
     "s.toml:2: material.quartz lacks the constants of the law \"linear\"; add normal_stiffness "
     "and shear_stiffness, or effective_modulus and stiffness_ratio"},
    {10, "source = \"lattice\"\nlattice = \"fcc\"\nradius = 1e-3\noverlap = 1e-3\npressure = 1e5",
     "s.toml:14: specimen.pressure = 100000 contradicts overlap; keep one of the two"},
    {10, "source = \"lattice\"\nlattice = \"square\"",
     "s.toml:11: specimen.lattice = \"square\" is a lattice of 2 dimensions; set dimension = 2"},
    {10, "source = \"lattice\"\nlattice = \"fcc\"\ncells = [1, 2.5, 1]",
     "s.toml:12: specimen.cells must hold whole numbers"},
    {10, "source = \"lattice\"\nlattice = \"fcc\"\ncells = [1, 2]",
     "s.toml:12: specimen.cells must hold 3 numbers, not 2"},
    {10, "source = \"lattice\"\nlattice = \"fcc\"\ncells = [100000, 100000, 1]",
     "s.toml:12: specimen.cells make more than 500 million cells"},
    {10, "source = \"file\"", "s.toml:9: specimen.path is missing; add \"path\" to [specimen]"},
    {12, "grading = { max_radius = 1e-3 }",
     "s.toml:12: specimen.grading.min_radius is missing; add \"min_radius\" to [specimen.grading]"},
    {12, "grading = { diameter = 1e-3 }",
     "s.toml:12: specimen.grading.diameter is not a known key; known here: coarse, fines, fines_content, "
     "max_radius, min_radius, passing, radius"},
    {12, "grading = {}",
     "s.toml:12: specimen.grading holds no sizes; give radius, or min_radius and max_radius, or passing, or coarse, "
     "fines and fines_content"},
    {12, "grading = { radius = 1e-3, max_radius = 1e-3 }",
     "s.toml:12: specimen.grading.max_radius = 0.001 is not the only size given; give radius, or min_radius and "
     "max_radius, or passing, or coarse, fines and fines_content"},
    {12, "grading = { coarse = [2e-3, 3e-3], fines = [2e-4, 3e-4] }",
     "s.toml:12: specimen.grading.fines_content is missing; add \"fines_content\" to [specimen.grading]"},
    {12, "grading = { coarse = [2e-3, 3e-3], fines = [2e-4, 3e-4], fines_content = 25 }",
     "s.toml:12: specimen.grading.fines_content = 25 must lie in (0, 1)"},
    {12, "grading = { coarse = [2e-3, 2e-3], fines = [2e-4, 3e-4], fines_content = 0.25 }",
     "s.toml:12: specimen.grading.coarse must be [smallest, largest] diameter; for one size give a narrow range"},
    {12, "grading = { coarse = [2e-4, 3e-4], fines = [2e-3, 3e-3], fines_content = 0.25 }",
     "s.toml:12: specimen.grading.fines must all be smaller than the coarse grains"},
    {12, "grading = { radius = 1e-3 }\nscale = 0", "s.toml:13: specimen.scale = 0 must be finite and > 0"},
    {12, "grading = { radius = 1e-3 }\ncoarse_count = 20",
     "s.toml:13: specimen.coarse_count = 20 contradicts count; keep one of the two"},
    {11, "coarse_count = 20",
     "s.toml:11: specimen.coarse_count = 20 counts the coarse grains of a gap grading, which this is not; give count, "
     "or grading = { coarse = …, fines = …, fines_content = … }"},
    {14, "type = \"free\"\nwall_material = \"quartz\"",
     "s.toml:15: boundary.wall_material = \"quartz\" is read with type = \"box\" only; remove one of the two"},
    {12, "grading = { min_radius = 2e-3, max_radius = 1e-3 }",
     "s.toml:12: specimen.grading.max_radius = 0.001 must not be below min_radius"},
    {12, "grading = { passing = [[1e-3, 0], [1e-3, 1]] }",
     "s.toml:12: specimen.grading.passing must ascend in diameter and in passing, but row 2 does not"},
    {12, "grading = { passing = [[1e-3, 0], [2e-3, 100]] }",
     "s.toml:12: specimen.grading.passing must run from passing 0 to passing 1; write fractions of the mass, not per "
     "cent"},
    {14, "type = \"free\"", "s.toml:19: stage[1].stress needs a periodic cell; set boundary.type = \"periodic\""},
    {14, "type = \"periodic\"\n[[boundary.wall]]\nname = \"floor\"",
     "s.toml:15: boundary.wall cannot stand in a cell that is periodic in every direction; set boundary.type to "
     "\"free\" or \"box\""},
    {14, "type = \"free\"\n[[boundary.wall]]\nname = \"floor\"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]",
     "s.toml:18: boundary.wall[1].normal must have a length above 0"},
    {16, "fixed = 1e-6",
     "s.toml:16: timestep.fixed = 1e-06 is read with policy = \"fixed\" only; remove one of the two"},
    {19, "stress = { isotropic = 100e3, x = 2e5 }",
     "s.toml:19: stage[1].stress.x = 200000 drives a component that is driven already; give each component one stress "
     "or one rate"},
    {19, "stress = { z = 100e3 }\nstrain_rate = { z = 0.1 }",
     "s.toml:20: stage[1].strain_rate.z = 0.1 drives a component that is driven already; give each component one "
     "stress "
     "or one rate"},
    {19, "stress = { x = 1e5 }\nhold = { mean_stress = 1e5, equal = [\"x\"] }",
     "s.toml:20: stage[1].hold.equal drives a component that is driven already; give each component one stress or one "
     "rate"},
    {19, "hold = { mean_stress = 1e5, equal = [\"w\"] }",
     "s.toml:19: stage[1].hold.equal[1] = \"w\" must be one of \"x\", \"y\", \"z\""},
    {19, "hold = { mean_stress = 1e5, equal = [] }",
     "s.toml:19: stage[1].hold.equal must name at least one axis; for example equal = [\"x\", \"y\"]"},
    {19, "hold = { mean_stress = 1e5 }",
     "s.toml:19: stage[1].hold makes 1 condition for 3 components that nothing else drives (x, y, z); there must be "
     "one "
     "for each: add conditions, or drive components by stress or strain_rate"},
    {19, "stress = { isotropic = 1e5 }\nhold = { deviator = 0 }",
     "s.toml:20: stage[1].hold makes 1 condition for 0 components that nothing else drives (none); there must be one "
     "for "
     "each: add conditions, or drive components by stress or strain_rate"},
    {19,
     "hold = { mean_stress = 1e5, deviator = 0, combinations = [{ stress = { x = 1, y = 1, z = 1 }, value = 3e5 }] }",
     "s.toml:19: stage[1].hold holds conditions that contradict each other or say the same twice; each must add "
     "something that the others leave open"},
    {19, "hold = {}",
     "s.toml:19: stage[1].hold names no condition; give mean_stress, deviator, b, volume_rate, equal or combinations"},
    {19, "hold = { combinations = [{ value = 0 }] }",
     "s.toml:19: stage[1].hold.combinations[1] must weigh either stresses or strain rates; for example { stress = { z "
     "= "
     "1, x = -2 }, value = 0 }"},
    {19, "strain_rate = { inertial_number = 1e-3 }",
     "s.toml:19: stage[1].strain_rate.inertial_number = 0.001 needs an axis beside it; for example { axis = \"z\", "
     "inertial_number = 1e-3 }"},
    {19, "strain_rate = { z = 1 }\ncycle = { amplitude = 1e3 }",
     "s.toml:20: stage[1].cycle must run between limits of either a stress or a strain; for example { stress = "
     "\"deviator\", mean = 0, amplitude = 20e3 }"},
    {19, "friction = { start = 0.5 }",
     "s.toml:19: stage[1].friction must aim at either a void_ratio or a mean_stress; for example { start = 0.5, "
     "void_ratio = 0.6 }"},
    {19, "friction = { start = 0, void_ratio = 0.6 }", "s.toml:19: stage[1].friction.start = 0 must be finite and > 0"},
    {19, good_scene[18] + "\nfriction = { start = 0.5, void_ratio = 0.6 }",
     "s.toml:20: stage[1].friction falls whenever the packing is at rest, but until names no rest; add "
     "unbalanced_force to until"},
    {14, "type = \"box\"\n[[stage]]\nname = \"a\"\nfriction = { start = 0.5, void_ratio = 0.6 }\nuntil = { steps = 1 }",
     "s.toml:17: stage[1].friction as a schedule needs a periodic cell; give a number"},
    {19, good_scene[18] + "\nradius_growth = 1",
     "s.toml:20: stage[1].radius_growth = 1 finds radii that have their sizes already; add expand_to to [specimen]"},
    {12, good_scene[11] + "\nexpand_to = 0.2",
     "s.toml:13: specimen.expand_to = 0.2 must be above solid_fraction = 0.3; the grains of the cloud grow until they "
     "fill the box so far"},
    {12, good_scene[11] + "\nexpand_to = 0.6",
     "s.toml:9: specimen has expand_to, but no stage lets grains grow; add radius_growth to a stage"},
    {20, "until = { cycles = 3 }",
     "s.toml:20: stage[1].until.cycles = 3 needs a cycle to count; add cycle = { … } to the stage"},
    {20, "until = { displacement = 1e-3 }",
     "s.toml:20: stage[1].until.displacement = 0.001 needs a body that moves; use time, steps or a strain, or add "
     "walls"},
    {6, "friction = \".25\"", "s.toml:6: material.quartz.friction = \".25\" must be a number; write 0.25"},
    {20, "until = {}",
     "s.toml:20: stage[1].until names no condition; give at least one of stress_error, unbalanced_force, time, steps, "
     "axial_strain, shear_strain, displacement, cycles"},
    {19, "",
     "s.toml:20: stage[1].until.stress_error = 0.001 needs a stress that is aimed at; add stress or hold to the "
     "stage, or a servo to a body"},
    {20, good_scene[19] + "\n[[stage]]\nname = \"compress\"\nuntil = { steps = 1 }",
     "s.toml:22: stage[2].name = \"compress\" is the name of another stage already; give every stage a name of its "
     "own"},
    {6, "friction = 0.25\n[material.a]\ndensity = 1",
     "s.toml:7: material.a.friction is missing; add \"friction\" to [material.a]"},
    {8, "law = \"linear\"\n[material.a]\ndensity = 1\nfriction = 0\nnormal_stiffness = 1\neffective_modulus = 1",
     "s.toml:2: material.quartz lacks the constants of the law \"linear\"; add normal_stiffness and shear_stiffness, "
     "or "
     "effective_modulus and stiffness_ratio"},
};

const std::string plane =
    "dimension = 2\ncontact.law = \"linear\"\nspecimen = { source = \"cloud\", count = 3, grading = "
    "{ radius = 1 } }\nboundary.type = \"periodic\"\n";
const std::string soft = "[material.soft]\ndensity = 1\nfriction = 0\nnormal_stiffness = 1\nshear_stiffness = 1\n";

const std::vector<SceneCase> plane_cases{
    {0, plane + soft + "effective_modulus = 1\nstiffness_ratio = 1\n",
     "s.toml:10: material.soft.effective_modulus = 1 contradicts normal_stiffness; keep one set of the two"},
    {0, plane + soft + "[material.hard]\ndensity = 1\nfriction = 0\neffective_modulus = 1\nstiffness_ratio = 1\n",
     "s.toml:10: material.hard gives other constants than material.soft; describe all materials by the same constants"},
    {0, plane + soft + "[[stage]]\nname = \"a\"\nstrain_rate = { z = 1 }\nuntil = { steps = 1 }\n",
     "s.toml:12: stage[1].strain_rate.z = 1 is not a component of a 2D scene; a 2D scene has x, y and xy"},
    {0, "dimension = 2\nmaterial = {}\n", "s.toml:2: material holds no material; add [material.NAME]"},
};

TEST(BadInputs, GoodSceneIsGood) {
  EXPECT_EQ(message_of([] { eg::parse_scene(scene_with(1, good_scene[0]), "s.toml"); }), "");
  EXPECT_EQ(message_of([] { eg::parse_scene(plane + soft, "s.toml"); }), "");
}

TEST(BadInputs, Scenes) {
  for (const auto& cases : {scene_cases, plane_cases})
    for (const auto& c : cases)
      EXPECT_EQ(message_of([&] { eg::parse_scene(scene_with(c.line, c.text), "s.toml"); }), c.message)
          << "line " << c.line << " := " << c.text;
}

struct PackingCase {
  std::string text, message;
};

const std::vector<PackingCase> packing_cases{
    {"", "p.txt: is an empty packing: it holds no numbers; write `Lx Ly Lz`, then `x y z r` a line"},
    {"1 1 1\n", "p.txt: is an empty packing: no grain follows the cell; write `x y z r` a line"},
    {"1 1 1 1\n",
     "p.txt:1: the first line must hold 2 or 3 numbers, not 4; write the edges of the periodic cell, `Lx Ly "
     "Lz` (2D: `Lx Ly`)"},
    {"1 1 1\n.5 .5 .5 .1\n.2 .5 .5 .1\n1.5 .5 .5 .2\n",
     "p.txt: grains 1 and 3 lie at one point, where no contact force has a direction; move or remove one of them"},
    {"1 0 1\n", "p.txt:1: Ly = 0 must be > 0; edges are lengths in metres"},
    {"1 1 1\n0 0 0 -0.1\n", "p.txt:2: radius = -0.1 must be > 0"},
    {"1 1 1\n# c\n0 nan 0 0.1\n", "p.txt:3: \"nan\" is not a finite number; write numbers between blanks"},
    {"1 1 1\n0,0,0,0.1\n", "p.txt:2: \"0,0,0,0.1\" is not a finite number; write numbers between blanks"},
    {"1 1 1\n0 1e999 0 0.1\n", "p.txt:2: \"1e999\" is not a finite number; write numbers between blanks"},
    {"1 1 1\n0 0 0 0.1 5\n", "p.txt:2: the line holds 5 numbers, not 4; write `x y z r`"},
    {"1 1\n0 0 0 0.1\n", "p.txt:2: the line holds 4 numbers, not 3; write `x y r`"},
    {"1 1 1\n0 0 0 0.1\n0 0",
     "p.txt:3: the last line holds 2 numbers, not 4; the file ends in the middle of a line; get a whole copy"},
    {"1 1 2\n0 0 0 0.6\n",
     "p.txt:2: radius = 0.6 makes a grain larger than the cell, whose shortest edge is 1; all "
     "lengths are in metres"},
    {std::string("1 1 1\n0\0 0 0 0.1\n", 16),
     "p.txt: is a binary file, but a packing is plain text; write `Lx Ly Lz`, then `x y z r` a line"},
    {"\xFD"
     "7zXZ...",
     "p.txt: is packed by xz, but a packing is plain text; unpack it first: unxz FILE"},
};

struct SettingCase {
  std::string setting, message;
};

const std::vector<SettingCase> setting_cases{
    {"specimen.count",
     "s.toml: the setting \"specimen.count\" has no value; write KEY=VALUE, for example "
     "specimen.count=300"},
    {"specimen.count=",
     "s.toml: the setting \"specimen.count=\" has no TOML value after \"=\"; write a number, true, "
     "false, [list], {table} or \"text\""},
    {"=3", "s.toml: the setting \"=3\" has no dotted path of keys before \"=\"; write for example specimen.count=300"},
    {"specimen..count=3",
     "s.toml: the setting \"specimen..count=3\" has no dotted path of keys before \"=\"; write for "
     "example specimen.count=300"},
    {"specimen.count=3\nseed=4",
     "s.toml: the setting \"specimen.count=3?seed=4\" holds more than one value; give every "
     "setting a --set of its own"},
    {"stage[0].name=a",
     "s.toml: the setting \"stage[0].name=a\" has an index that is not a number from 1; write "
     "stage[1] for the first stage"},
    {"stage[2].name=a", "s.toml: the setting \"stage[2].name=a\" asks for element 2 of 1; count from 1"},
    {"stage.name=a", "s.toml: the setting \"stage.name=a\" does not say which \"stage\"; write stage[1]"},
    {"specimen[1]=a",
     "s.toml: the setting \"specimen[1]=a\" takes \"specimen\" for an array, which it is not; leave the "
     "index out"},
    {"dimension.x=3",
     "s.toml: the setting \"dimension.x=3\" takes \"dimension\" for a table, which it is not; shorten "
     "the path"},
    {"specimen.cout=3", "s.toml: specimen.cout is not a known key; did you mean \"count\"?"},
    {"specimen.count=0", "s.toml: specimen.count = 0 must lie in [1, 4000000000]"},
    {"specimen.grading={radus=1}", "s.toml: specimen.grading.radus is not a known key; did you mean \"radius\"?"},
};

TEST(BadInputs, Settings) {
  for (const auto& c : setting_cases)
    EXPECT_EQ(message_of([&] { eg::parse_scene(scene_with(1, good_scene[0]), "s.toml", {c.setting}); }), c.message);
  EXPECT_EQ(message_of([&] { eg::parse_scene(scene_with(1, "settings = []\ndimension = 3"), "s.toml", {"seed=1"}); }),
            "s.toml:1: settings are in the scene already; add yours to that line of the file");
}

TEST(BadInputs, Packings) {
  for (const auto& c : packing_cases)
    EXPECT_EQ(message_of([&] { eg::parse_packing(c.text, "p.txt"); }), c.message) << c.text;
}

eg::State good_state() {
  eg::State s;
  s.grains.position = {{0, 0, 0, 1}, {1, 0, 0, 1}};
  s.grains.velocity = {{0, 0, 0, 1}, {0, 0, 0, 1}};
  s.grains.id = {1, 2};
  s.contacts.i = s.contacts.j = std::vector<eg::Index>(8, 0);
  s.contacts.j[0] = 1;
  s.contacts.chunk_begin = {0, 8};
  s.friction = {0.25};
  return s;
}

struct StateCase {
  std::function<void(eg::State&)> spoil;
  std::string message;  ///< after "NAME: ", before the remedy
};

const double nan = std::numeric_limits<double>::quiet_NaN();

const std::vector<StateCase> state_cases{
    {[](eg::State&) {}, ""},
    {[](eg::State& s) { s.dimension = 2; }, "dimension = 2 must be that of the scene, 3"},
    {[](eg::State& s) { s.dt = -1; }, "dt = -1 must be finite and >= 0"},
    {[](eg::State& s) { s.grains.position[1].y = nan; }, "grains/position[1] = (1, nan, 0) must be finite"},
    {[](eg::State& s) { s.grains.position[1].w = 0; }, "grains/radius[1] = 0 must be > 0"},
    {[](eg::State& s) { s.grains.velocity[0].w = -1; },
     "grains/velocity[0] = (0, 0, 0; -1) must be finite, the inverse mass not negative"},
    {[](eg::State& s) { s.grains.id.pop_back(); }, "length of grains/id = 1 must be 2"},
    {[](eg::State& s) {
       s.grains.material = {0, 1};
     },
     "grains/material[1] = 1 must be below 1"},
    {[](eg::State& s) { s.contacts.j[0] = 2; }, "contacts/j[0] = 2 must be below 2"},
    {[](eg::State& s) { s.contacts.image.assign(8, 27); }, "contacts/image[0] = 27 must be below 27"},
    {[](eg::State& s) {
       s.contacts.chunk_begin = {0, 9};
     },
     "contacts/chunk_begin[1] = 9 must ascend to 8"},
    {[](eg::State& s) {
       s.wall_contacts = {{0, 3}};
     },
     "wall_contacts/wall[0] = 3 must be below 0"},
    {[](eg::State& s) { s.cell.h(1, 1) = 0; }, "cell/matrix diagonal = 0 must be > 0"},
    {[](eg::State& s) {
       s.friction = {0, 0};
     },
     "length of friction = 2 must be 1"},
    {[](eg::State& s) { s.stage = 2; }, "stage/number = 2 must not pass the number of stages, 1"},
};

TEST(BadInputs, States) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  const auto scene = eg::parse_scene(scene_with(1, good_scene[0]));
  for (const auto& c : state_cases) {
    auto state = good_state();
    c.spoil(state);
    eg::write_snapshot(path, scene, state);
    const std::string expected =
        c.message.empty() ? "" : path + ": " + c.message + "; the file is damaged; use another snapshot";
    EXPECT_EQ(message_of([&] { eg::read_snapshot(path); }), expected);
  }
}

TEST(BadInputs, Files) {
  const Scratch scratch;
  const std::string path = scratch / "file";
  const auto snapshot_message = [&] { return message_of([&] { eg::read_snapshot(path); }); };
  EXPECT_EQ(message_of([&] { eg::read_scene(path); }),
            path + ": cannot be opened (No such file or directory); check the path");
  EXPECT_EQ(snapshot_message(), path + ": cannot be opened (No such file or directory); check the path");
  EXPECT_EQ(message_of([&] { eg::read_packing(scratch.folder()); }),
            scratch.folder() + ": is a folder, not a file; name a file in it");

  eg::write_file(path, "");
  EXPECT_EQ(snapshot_message(), path + ": is an empty file: it holds no bytes; name a .h5 file that a run has written");
  eg::write_file(path,
                 "\xEF\xBB\xBF"
                 "1 1 1\n0 0 0 0.1\n");
  EXPECT_EQ(eg::read_packing(path).size(), 1u);
  eg::write_file(path, "1 1 1\n0 0 0 0.1\n");
  EXPECT_FALSE(eg::looks_like_snapshot(path));
  EXPECT_EQ(snapshot_message(),
            path + ": is no snapshot: it is not an HDF5 file; name a .h5 file that a run has written");

  eg::write_snapshot(path, eg::parse_scene(scene_with(1, good_scene[0])), good_state());
  const std::string whole = eg::read_file(path);
  eg::write_file(path, whole.substr(0, whole.size() / 2));
  EXPECT_EQ(snapshot_message(),
            path + ": is damaged: HDF5 cannot open it, it may have been cut short; use another snapshot");

  const auto only = [&](auto... version) {
    eg::Hdf5Writer file(path, path);
    (file.write("format_version", "", {}, std::vector<int>{version}), ...);
    file.write_text("program_version", "9.9");
    file.write_text("scene/text", scene_with(1, good_scene[0]));
    file.write_text("scene/file", "s.toml");
    file.close();
  };
  only();
  EXPECT_EQ(snapshot_message(), path +
                                    ": is no snapshot: it is an HDF5 file of another program; name a .h5 file that a "
                                    "run has written");
  only(2);
  EXPECT_EQ(snapshot_message(), path +
                                    ": format_version = 2 must be 1 for eigengrain 0.1.0; read it with the version "
                                    "that wrote it, 9.9");
  only(1);
  EXPECT_EQ(snapshot_message(), path +
                                    ": has no dataset dimension: an earlier eigengrain wrote it, or it is damaged; "
                                    "read it with the version that wrote it, or use another snapshot");
}

/// A snapshot with one stretch of bytes changed either reads or gives one line; it never crashes.
TEST(BadInputs, DamagedSnapshotsGiveOneLine) {
  const Scratch scratch;
  const std::string path = scratch / "state.h5";
  eg::write_snapshot(path, eg::parse_scene(scene_with(1, good_scene[0])), good_state());
  const std::string whole = eg::read_file(path);
  int refused = 0;
  for (std::size_t at = 0; at + 8 < whole.size(); at += 211) {
    std::string spoilt = whole;
    for (std::size_t k = 0; k < 8; ++k) spoilt[at + k] = static_cast<char>(~spoilt[at + k]);
    eg::write_file(path, spoilt);
    const auto message = message_of([&] { eg::read_snapshot(path); });
    refused += !message.empty();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_GT(refused, 10);
}

TEST(BadInputs, AreManyAndDistinct) {
  std::vector<std::string> messages;
  for (const auto& c : scene_cases) messages.push_back(c.message);
  for (const auto& c : packing_cases) messages.push_back(c.message);
  for (const auto& c : state_cases) messages.push_back(c.message);
  std::ranges::sort(messages);
  messages.erase(std::unique(messages.begin(), messages.end()), messages.end());
  EXPECT_GE(messages.size(), 80u);
}

}  // namespace
