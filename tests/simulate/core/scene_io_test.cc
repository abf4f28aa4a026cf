// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulate/core/scene_io.h"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "tests/simulate/core/fault.h"

namespace flocklift {
namespace {

Scene Parse(const std::string& text) { return ParseScene(text, "FILE"); }

TEST(Scene, HasDefaults) {
  const Scene scene = Parse("[[species]]\n");
  const Scene defaults;
  EXPECT_EQ(scene.seed, defaults.seed);
  EXPECT_EQ(scene.duration, defaults.duration);
  EXPECT_EQ(scene.box.low, defaults.box.low);
  ASSERT_EQ(scene.species.size(), 1u);
  EXPECT_EQ(scene.species[0].model.name, "boids");
  EXPECT_EQ(scene.species[0].start, std::nullopt);
  EXPECT_EQ(scene.camera.file, std::nullopt);
  EXPECT_EQ(scene.FrameCount(), 300);
}

TEST(Scene, EveryKeyIsRead) {
  const Scene scene = Parse(R"(
[scene]
version = 1
seed = 12
duration = 2.5
fps = "30000/1001"
substeps = 2
dimensions = 3
warmup = 1
box = [[-1, -2, -3], [4, 5, 6]]
[[species]]
name = "midge"
count = 7
wingspan = 0.01
wingspan_spread = 0.1
body_length = 0.004
wingbeat_hz = 500
speed = 0.5
speed_spread = 0.2
start = [[0, 0, 0], [1, 1, 1]]
model = "linear"
[species.parameters]
cohesion = 2
[[species]]
name = "bird"
[[goal]]
species = "midge"
position = [1, 2, 3]
radius = 4
period = 5
weight = 6
[[predator]]
count = 2
speed = 3
fear_radius = 4
fear_weight = 5
turn_interval = 6
[camera]
fov = 70
size = [640, 480]
position = [1, 1, 1]
look_at = [2, 2, 2]
[render]
background = "sky"
noise = 1
blur = 0.5
haze = 0
cloud_speed = -2
)");
  EXPECT_EQ(scene.seed, 12u);
  EXPECT_EQ(scene.duration, 2.5);
  EXPECT_EQ(scene.fps, 30000.0 / 1001);
  EXPECT_EQ(scene.substeps, 2);
  EXPECT_EQ(scene.warmup, 1);
  EXPECT_EQ(scene.box.low, (Vec3d{-1, -2, -3}));
  EXPECT_EQ(scene.box.high, (Vec3d{4, 5, 6}));
  ASSERT_EQ(scene.species.size(), 2u);
  const SpeciesSpec& midge = scene.species[0];
  EXPECT_EQ(midge.name, "midge");
  EXPECT_EQ(midge.count, 7);
  EXPECT_EQ(midge.wingspan, 0.01);
  EXPECT_EQ(midge.wingspan_spread, 0.1);
  EXPECT_EQ(midge.body_length, 0.004);
  EXPECT_EQ(midge.wingbeat_hz, 500);
  EXPECT_EQ(midge.speed, 0.5);
  EXPECT_EQ(midge.speed_spread, 0.2);
  EXPECT_EQ(midge.start->high, (Vec3d{1, 1, 1}));
  EXPECT_EQ(midge.model.name, "linear");
  EXPECT_EQ(midge.model.parameters.at("cohesion"), 2);
  EXPECT_EQ(midge.model.where, "FILE:21");
  EXPECT_EQ(midge.model.WhereOf("cohesion"), "FILE:23");
  EXPECT_EQ(midge.model.WhereOf("alignment"), "FILE:21");
  ASSERT_EQ(scene.goals.size(), 1u);
  EXPECT_EQ(scene.goals[0].species, "midge");
  EXPECT_EQ(scene.goals[0].position, (Vec3d{1, 2, 3}));
  EXPECT_EQ(scene.goals[0].radius, 4);
  EXPECT_EQ(scene.goals[0].period, 5);
  EXPECT_EQ(scene.goals[0].weight, 6);
  ASSERT_EQ(scene.predators.size(), 1u);
  EXPECT_EQ(scene.predators[0].count, 2);
  EXPECT_EQ(scene.predators[0].speed, 3);
  EXPECT_EQ(scene.predators[0].fear_radius, 4);
  EXPECT_EQ(scene.predators[0].fear_weight, 5);
  EXPECT_EQ(scene.predators[0].turn_interval, 6);
  EXPECT_EQ(scene.camera.fov_deg, 70);
  EXPECT_EQ(scene.camera.width, 640);
  EXPECT_EQ(scene.camera.height, 480);
  EXPECT_EQ(scene.camera.position, (Vec3d{1, 1, 1}));
  EXPECT_EQ(scene.camera.look_at, (Vec3d{2, 2, 2}));
  EXPECT_EQ(scene.render.background, "sky");
  EXPECT_EQ(scene.render.noise, 1);
  EXPECT_EQ(scene.render.blur, 0.5);
  EXPECT_EQ(scene.render.haze, 0);
  EXPECT_EQ(scene.render.cloud_speed_px, -2);

  const std::string text = FormatScene(scene);
  EXPECT_EQ(FormatScene(Parse(text)), text);
}

TEST(Scene, MayBeFlat) {
  const Scene scene = Parse(
      "[scene]\ndimensions = 2\n[[species]]\nstart = [[0, 1, 5], [2, 3, 7]]\n"
      "[[goal]]\nposition = [4, 5]\n");
  EXPECT_EQ(scene.box.low, (Vec3d{-20, -20, 0}));
  EXPECT_EQ(scene.box.high, (Vec3d{20, 20, 0}));
  EXPECT_EQ(scene.species[0].start->high, (Vec3d{2, 3, 0}));
  EXPECT_EQ(scene.goals[0].position, (Vec3d{4, 5, 0}));
  EXPECT_EQ(FormatScene(Parse(FormatScene(scene))), FormatScene(scene));
}

TEST(Scene, CameraFileIsBesideTheScene) {
  const std::string text = "[[species]]\n[camera]\nfile = \"lens.yaml\"\n";
  EXPECT_EQ(ParseScene(text, "scenes/a.toml").camera.file, "scenes/lens.yaml");
  EXPECT_EQ(ParseScene(text, "a.toml").camera.file, "lens.yaml");
  const Scene absolute = Parse("[[species]]\n[camera]\nfile = \"/etc/lens.yaml\"\n");
  EXPECT_EQ(absolute.camera.file, "/etc/lens.yaml");
}

TEST(Scene, SurvivesAFile) {
  const TemporaryFolder folder;
  Scene scene;
  scene.duration = 1.0 / 3;
  scene.species.emplace_back().name = "odd \"name\" \\ \n\t\x01 \xC3\xA4";
  scene.species[0].model.parameters = {{"a b", 0.1}, {"x", 1e-300}, {"", -2e8}};
  WriteScene(folder / "scene.toml", scene);
  const Scene read = ReadScene(folder / "scene.toml");
  EXPECT_EQ(read.duration, scene.duration);
  EXPECT_EQ(read.species[0].name, scene.species[0].name);
  EXPECT_EQ(read.species[0].model.parameters, scene.species[0].model.parameters);
  EXPECT_THROW(ReadScene(folder / "none.toml"), InputError);
}

// Everything that surrounds the animals.
constexpr const char* kSurroundings = R"(
[[species]]
start = "moon"
shape = "horse"
path = "lane"
[species.parameters]
gain = 2
noise = "curl"
[[species.force]]
type = "wind"
rate = 3
[[goal]]
waypoints = [{ time = 0, position = [1, 2, 3] }, { time = 2, position = [4, 5, 6] }]
reach = 0.5
[[predator]]
hunt = "chase"
[[obstacle]]
mesh = "house.obj"
position = [1, 2, 3]
yaw = 30
scale = 2
[[obstacle]]
box = [[0, 0, 0], [1, 1, 1]]
[[obstacle]]
radius = 4
[[shape]]
name = "moon"
mesh = "moon.ply"
[[shape]]
name = "horse"
key_frames = [{ mesh = "a.ply", time = 0 }, { mesh = "b.ply", time = 0.5 }]
period = 1
path = "lane"
[[path]]
name = "lane"
points = [[0, 0, 0], [1, 1, 1], [2, 0, 1]]
speed = 3
width = 2
[wind]
velocity = [1, 0, 0]
gust = 0.5
gust_time = 2
[[event]]
time = 1
species = "bird"
parameters = { gain = 3, noise = "white" }
goal = 1
position = [9, 9, 9]
wind = [0, 1, 0]
[camera]
path = [{ time = 0 }, { time = 3, position = [9, 0, 0] }]
[render]
obstacles = false
goals = true
paths = true
ground = true
)";

TEST(Scene, SurroundingsAreRead) {
  const Scene scene = ParseScene(kSurroundings, "scenes/a.toml");
  EXPECT_EQ(scene.species[0].start_shape, "moon");
  EXPECT_EQ(scene.species[0].model.choices.at("noise"), "curl");
  EXPECT_EQ(scene.species[0].forces[0].name, "wind");
  EXPECT_EQ(scene.species[0].forces[0].parameters.at("rate"), 3);
  EXPECT_EQ(scene.goals[0].waypoints[1].position, (Vec3d{4, 5, 6}));
  EXPECT_EQ(scene.goals[0].position, (Vec3d{1, 2, 3}));
  EXPECT_EQ(scene.goals[0].reach, 0.5);
  EXPECT_TRUE(scene.predators[0].chases);
  ASSERT_EQ(scene.obstacles.size(), 3U);
  EXPECT_EQ(scene.obstacles[0].mesh, "scenes/house.obj");
  EXPECT_EQ(scene.obstacles[0].placement.yaw_deg, 30);
  EXPECT_EQ(scene.obstacles[1].box->high, (Vec3d{1, 1, 1}));
  EXPECT_EQ(scene.obstacles[2].radius, 4);
  EXPECT_EQ(scene.shapes[1].key_frames[1].mesh, "scenes/b.ply");
  EXPECT_EQ(scene.shapes[1].period, 1);
  EXPECT_EQ(scene.paths[0].points.size(), 3U);
  EXPECT_EQ(scene.wind.gust_time, 2);
  EXPECT_EQ(scene.events[0].change.parameters.at("gain"), 3);
  EXPECT_EQ(scene.events[0].goal, 1U);
  EXPECT_EQ(scene.events[0].wind, (Vec3d{0, 1, 0}));
  EXPECT_EQ(scene.camera.path[0].position, scene.camera.position);
  EXPECT_EQ(scene.camera.path[1].position, (Vec3d{9, 0, 0}));
  EXPECT_TRUE(scene.render.ground && scene.render.goals && scene.render.paths);
  EXPECT_FALSE(scene.render.obstacles);
}

TEST(Scene, SurroundingsSurviveAFile) {
  const std::string once = FormatScene(ParseScene(kSurroundings, "scenes/a.toml"));
  EXPECT_EQ(FormatScene(Parse(once)), once);
}

TEST(Scene, FaultsAreTold) {
  const std::string scene = "[scene]\n", species = "[[species]]\n";
  const std::vector<Fault> faults{
      {"", 0, "no animals"},
      {"[scene\n", 1, "not TOML"},
      {"[scene]\nseed = 1\nseed = 2\n", 3, "not TOML"},
      {"x = [1,\n2\n", 2, "not TOML"},
      {"[scen]\n", 1, "unknown key `scen` in the scene; did you mean `scene`?"},
      {"scene = 3\n", 1, "scene in the scene is not a table"},
      {"species = 3\n", 1, "not a list of tables"},
      {"[species]\n", 1, "not a list of tables; write each below a heading [[species]]"},
      {"species = [3]\n", 1, "not a list of tables"},
      {"species = []\n", 1, "not a list of tables"},
      {scene + "durration = 3\n", 2,
       "unknown key `durration` in [scene]; did you mean `duration`?"},
      {scene + "zebra = 3\n", 2, "known are version, seed, duration"},
      {scene + "version = 2\n", 2, "schema version 2; this program reads version 1"},
      {scene + "seed = -1\n", 2, "seed in [scene] is -1; give a whole number from 0"},
      {scene + "seed = 1.5\n", 2, "seed in [scene] is not a whole number"},
      {scene + "duration = \"long\"\n", 2, "duration in [scene] is not a number"},
      {scene + "duration = nan\n", 2, "duration in [scene] is nan"},
      {scene + "duration = inf\n", 2, "duration in [scene] is inf"},
      {scene + "duration = 0\n", 2, "give a number above 0"},
      {scene + "duration = true\n", 2, "not a number"},
      {scene + "duration = 0.001\n", 2, "0.03 frames"},
      {scene + "duration = 80000\nfps = 100000\n", 2, "frames"},
      {scene + "fps = \"fast\"\n", 2, "fps in [scene] is no rate"},
      {scene + "fps = 0\n", 2, "fps in [scene] is no rate"},
      {scene + "fps = [1]\n", 2, "fps in [scene] is no rate"},
      {scene + "substeps = 0\n", 2, "from 1 to 1000"},
      {scene + "dimensions = 4\n", 2, "from 2 to 3"},
      {scene + "warmup = -1\n", 2, "at least 0"},
      {scene + "box = 3\n", 2, "box in [scene] is not a list"},
      {scene + "box = [1, 2]\n", 2, "not a pair of corners"},
      {scene + "box = [[1, 2, 3]]\n", 2, "not a pair of corners"},
      {scene + "box = [\n[1, 2, 3],\n[1, 2]]\n", 4, "box in [scene] has 2 numbers"},
      {scene + "box = [[0, 0, 0], [1, 1, \"a\"]]\n", 2, "not a number"},
      {scene + "box = [[0, 0, 0], [1, 0, 1]]\n", 2, "no extent"},
      {scene + "box = [[0, 0, 0], [1, 1, 0]]\n", 2, "no extent"},
      {scene + "box = [[2, 0, 0], [1, 1, 1]]\n", 2, "no extent"},
      {species + "count = 0\n", 2, "count in [[species]] is 0"},
      {species + "count = 2000000\n", 2, "count"},
      {species + "wingspan = 0\n", 2, "wingspan in [[species]] is 0; give a number above 0"},
      {species + "wing_span = 1\n", 2, "did you mean `wingspan`?"},
      {species + "speed_spread = 2\n", 2, "at most 1"},
      {species + "name = 3\n", 2, "name in [[species]] is not text"},
      {species + "model = 3\n", 2, "model in [[species]] is not text"},
      {species + "parameters = 3\n", 2, "not a table"},
      {species + "[species.parameters]\na = true\n", 3,
       "`a` in [species.parameters] is not a number"},
      {species + "[species.parameters]\na = 1\nb = nan\n", 4, "`b` in [species.parameters] is nan"},
      {species + "[[species.force]]\ngain = 1\n", 2, "type is missing in [[species.force]]"},
      {species + "shape = \"moon\"\n", 0, "species `bird` has the shape `moon`"},
      {species + "path = \"p\"\n[path]\npoints = [[0, 0, 0], [1, 1, 1]]\n", 0, "known are path"},
      {species + species, 2, "two species are called `bird`"},
      {species + "[[obstacle]]\n", 2, "mesh, box or radius (a ball); give exactly one"},
      {species + "[[obstacle]]\nradius = 1\nmesh = \"a.obj\"\n", 2, "give exactly one"},
      {species + "[[obstacle]]\nmesh = \"\"\n", 3, "mesh in [[obstacle]] is empty"},
      {species + "[[shape]]\nname = \"a\"\n", 2, "the shape has no mesh"},
      {species + "[[shape]]\nmesh = \"a.ply\"\n", 2, "name is missing in [[shape]]"},
      {species + "[[shape]]\nname = \"a\"\nkey_frames = [{ mesh = \"a\", time = 1 }, "
                 "{ mesh = \"b\", time = 1 }]\n",
       4, "not in the order of time"},
      {species + "[[shape]]\nname = \"a\"\nmesh = \"a.ply\"\npath = \"x\"\n", 0, "path `x`"},
      {species + "[path]\npoints = [[0, 0, 0]]\n", 2, "fewer than two points"},
      {species + "[path]\npoints = [[0, 0, 0], 3]\n", 3, "something that is no point"},
      {species + "[wind]\ngust_time = 0\n", 3, "above 0"},
      {species + "[[event]]\n", 2, "time is missing in [[event]]"},
      {species + "[[event]]\ntime = 1\ngoal = 1\n", 4, "goal in [[event]] is 1"},
      {species + "[[event]]\ntime = 2\n[[event]]\ntime = 1\n", 4, "not in the order of time"},
      {species + "[[goal]]\nwaypoints = [{ time = 0 }]\n", 3, "position is missing"},
      {species + "[[predator]]\nhunt = \"chose\"\n", 3, "did you mean `chase`?"},
      {species + "[render]\nground = 1\n", 3, "neither true nor false"},
      {species + "[camera]\npath = [{ time = 1 }, { time = 0 }]\n", 3, "order of time"},
      {species + "[[goal]]\n", 2, "position is missing in [[goal]]"},
      {species + "[[goal]]\nposition = [1, 2]\n", 3, "position in [[goal]] has 2 numbers"},
      {species + "[[goal]]\nposition = [1, 2, 3]\nspecies = \"brid\"\n", 4, "did you mean `bird`?"},
      {species + "[[predator]]\nfear_radius = 0\n", 3, "above 0"},
      {species + "[camera]\nfov = 180\n", 3, "at most 170"},
      {species + "[camera]\nsize = [640]\n", 3, "no image size"},
      {species + "[camera]\nsize = [640, 4.5]\n", 3, "no image size"},
      {species + "[camera]\nsize = [640, 99999]\n", 3, "no image size"},
      {species + "[camera]\nfile = \"a\"\nfov = 30\n", 3, "a file and other keys"},
      {species + "[camera]\nfile = \"\"\n", 3, "empty"},
      {species + "[camera]\nposition = [0, 0, 12]\n", 2, "looks at its own position"},
      {species + "[render]\nbackground = \"cloud\"\n", 3, "did you mean `clouds`?"},
      {species + "[render]\nblur = 1.5\n", 3, "at most 1"},
      {species + "[render]\n\"od\\nd\" = 1\n", 3, "unknown key `od?d` in [render]"},
  };
  for (const Fault& fault : faults) ExpectFault(fault, Parse);
}

// What the schema's page shows must be read, and what is read must stand on the page.
TEST(Scene, PageAndReaderAgree) {
  const std::string page = Contents(FLOCKLIFT_SOURCE_DIR "/data_synthetic/README.md");
  const std::string fence = "```toml\n";
  const std::size_t begin = page.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const std::size_t first = begin + fence.size();
  const Scene example = Parse(page.substr(first, page.find("```", first) - first));
  EXPECT_EQ(example.species[0].name, "jackdaw");

  Scene full = example;
  full.goals.emplace_back().species = "jackdaw";
  full.species[0].start = full.box;
  full.species[0].model.parameters.clear();
  const Scene surroundings = Parse(kSurroundings);
  full.goals = surroundings.goals;
  full.obstacles = surroundings.obstacles;
  full.shapes = surroundings.shapes;
  full.paths = surroundings.paths;
  full.events = surroundings.events;
  full.events[0].change = {};
  full.camera.path = surroundings.camera.path;
  std::istringstream lines(FormatScene(full));
  std::string heading;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line[0] == '[') {
      heading = line;
      EXPECT_NE(page.find("## `" + heading + "`"), std::string::npos) << heading;
    } else {
      const std::string row = "\n| `" + line.substr(0, line.find(' ')) + "` |";
      const std::size_t section = page.find("## `" + heading + "`");
      const std::size_t end = page.find("\n## ", section);
      EXPECT_LT(page.find(row, section), end) << heading << " " << row;
    }
  }
}

}  // namespace
}  // namespace flocklift
