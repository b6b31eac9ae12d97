// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/item.h"

#include <algorithm>

#include "reproduce/layers.h"
#include "reproduce/master.h"
#include "reproduce/memory.h"
#include "reproduce/search.h"
#include "reproduce/tracks.h"
#include "reproduce/voxelisation.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"

namespace vicinity::report {

const std::vector<Item>& items() {
  static const std::vector<Item> all{
      {"dynamics",
       {"fig2", "fig3"},
       "Force field against drag in the hand (section 3.1.1)",
       "A force field acts whatever the velocity: it oscillates in narrow places, pushes and "
       "pulls at the edge of its zone (p1, p3 of figure 2), and goes on pushing a hand that "
       "stands still. Drag takes energy out only, vanishes at rest, and lets an object be "
       "reached slowly.",
       "One joint: mass 0.3 kg, own damping 1 N·s/m, read each millisecond, difference of two "
       "positions, held force, exact integration. The operator is a spring of 30 N/m and a "
       "damper of 1 N·s/m towards his target. Both methods act within 30 mm of a surface. The "
       "force field is a linear spring with 5 N at the surface and behind it; drag is the field "
       "of six layers (cube, m = 1) scaled so that rank 1 has 0.95 of the device's own damping, "
       "which is what a passive device bears. The slot is 40 mm wide; the post has a radius of "
       "20 mm and is passed 10 mm away.",
       dynamics},
      {"fig5",
       {},
       "Drag against layer, for a slow and a fast point",
       "A point at constant speed meets drag that rises in steps from layer to layer; a fast one "
       "(path b) meets much more than a slow one (path a), and one that stops falls back to "
       "almost none.",
       "The circular cylinder, five layers of m = 4 as in figure 4, 0.05 and 0.2 m/s: the paper "
       "names no object and no speed.",
       fig5},
      {"fig7",
       {"fig4", "fig6"},
       "Cost of finding the nearest surface",
       "Enclosing boxes and spheres sort out far objects only; near an object every triangle has "
       "to be looked at, one after the other, for every place of R.",
       "Spheres of radius 24 with 48 to 65,024 triangles, 2,000 points within 16 voxels of them "
       "(50 for the sequential scan). The scan is the paper's: normal, foot, inside test, least "
       "distance; the tree is Embree's, the distance to a triangle ours; the lookup is the "
       "field's. Times are of this machine and not in the CSV file.",
       fig7},
      {"fig8",
       {},
       "Shaded corners",
       "At a corner no triangle has an inner normal projection, so that the search fails: in "
       "zones at the edges of a pentagonal cylinder, and in numerous ones around a curved "
       "cylinder.",
       "Pentagon of circumradius 24, curved cylinder of radius 24 with 64 facets, both 40 high; "
       "the complex cylinder beside them, for its concavities. The vicinity is what lies within "
       "16 voxels of the surface, sampled at every other voxel; only triangles that R is before "
       "count. Zones are counted once around, 8 voxels outside.",
       fig8},
      {"fig9",
       {},
       "Voxels of a cylinder",
       "The top layer is surface voxels only; an intermediate layer is a closed contour of them, "
       "filled with body voxels.",
       "Radius 20, from z = 20 to 60, 128 facets. Areas count a boundary voxel as half inside.",
       fig9},
      {"fig11",
       {},
       "Probe vectors",
       "Grid lines should not run parallel to a triangle: lines normal to the largest face of "
       "its bounding brick intersect it reliably.",
       "Five parts. Against the exact definition (every voxel a triangle passes through), with "
       "the paper's choice, with z lines only, and with the smallest face. Lines run through "
       "voxel centres; a voxel met twice or more is doubled.",
       fig11},
      {"fig12",
       {},
       "Voxels of the wedge and the cube",
       "STL objects become voxel objects of the same shape.",
       "Wedge: a block of 60 x 60 x 40 with a V 28 deep and 40 wide; cube of 20. The cube's "
       "neighbours are in fig16.",
       fig12},
      {"fig13",
       {},
       "Voxels of the cone",
       "Horizontal sections, and the vertical section through the apex.",
       "The cone of figure 22: height 45, base radius 25, 256 facets.",
       fig13},
      {"fig14",
       {},
       "Voxels of the wedge at three heights",
       "Sections V1 to V3, starting from the base, of the block with the V.",
       "z = 35, 50 and 62: one below the junction of the V at z = 42, two above.",
       fig14},
      {"fig16",
       {"fig15"},
       "Ranked neighbours around a cube",
       "One pass of the floating analyser zone with m = 1 turns every empty voxel of the 27 "
       "around a boundary voxel into rank 1; repeating it on its own result grows the graded "
       "zone.",
       "A cube of 20 voxels; the paper shows no size.",
       fig16},
      {"fig17",
       {},
       "Cube FAZ of 5, 7 and 9 around cylinders",
       "Six layers. A bigger zone makes thicker layers; the outer ones lose the object's shape, "
       "since a cube is symmetric about the axes only.",
       "Circular cylinder of radius 20; complex cylinder of radius 40 with one narrow and four "
       "wider concavities; and the hollow one, which the paper shows with spheres only. Reach is "
       "the true distance of a layer's outermost voxels plus half a voxel, over the whole "
       "object, ends and edges included.",
       fig17},
      {"fig18",
       {},
       "Cube against sphere, m = 2",
       "Six layers around the circular and the complex cylinder. The first layers are nearly "
       "alike; at higher rank the sphere is much truer. The narrow concavity A fills up, the "
       "wider B to E stay open.",
       "The same cylinders. A concavity counts as filled where the contour of the third layer "
       "shows less than a quarter of its depth, and as open where it shows more than half.",
       fig18},
      {"fig19",
       {},
       "Spheres of m = 1 to 4; above the top",
       "Six layers by spheres of m = 3 and 4 around circular, complex and hollow cylinders, "
       "truer than smaller ones, at mid height and above the top, where all voxels are "
       "neighbours from the body below.",
       "m = 1 and 2 beside them. The hollow cylinder has radii 36 and 28, so that its bore is "
       "nearly full of layers. Kept shape is read as a spread of reach below a quarter of it.",
       fig19},
      {"table1",
       {},
       "Performance of the elements, in numbers",
       "In words: layers thin to wide; cubes distort diagonals highly, spheres moderately to "
       "little; redundant computation rises with the size of a cube, and for spheres it is low, "
       "lower, and lower still.",
       "A ball of radius 10, because its layers show an element in every direction; six ranks; m "
       "= 4 beside the paper's m = 1, 2, 3. Thickness is the mean reach of rank 6 over 6, least "
       "and most likewise; distortion compares reach along diagonals and axes. Redundant is the "
       "share of visited cells that changed nothing.",
       table1},
      {"fig20",
       {},
       "The cone, m = 1 to 4",
       "Vertical sections through the apex for spheres of m = 1, 3 and 4, and horizontal ones "
       "from z = 20 to 40 for m = 2 and 4.",
       "Horizontal sections at z = 20, 27, 33 and 40: the paper names the first and the last. "
       "Vertical sections for all four.",
       fig20},
      {"fig21",
       {},
       "The wedge, seven layers of m = 3",
       "Seen from x, from below and from y; the second view lies above the junction of the V.",
       "A block of 60 x 60 x 40 voxels with a V 28 deep and two thirds of the block wide. For "
       "seven layers we use the linear coding, since the text's has six values.",
       fig21},
      {"fig22",
       {},
       "Six tracks by the cone",
       "R moves parallel to y in the vertical plane that touches the cone's base, at z = 1, 10, "
       "20, 30, 40 and 45, with unit surface and speed and viscosities 32, 25, 20, 17, 15, 13. "
       "The higher, the less drag; track 6, level with the apex, meets no labelled voxel.",
       "A base radius of 25 voxels, since the paper gives the height only: with less than 24.5 "
       "the sixth track of an ideal cone would still meet rank 6. The plane is read as the first "
       "voxels beyond the base circle.",
       fig22},
      {"fig23",
       {},
       "The complex cylinder at y = 20, 50 and 80",
       "Six layers in sections at mid height, near the top and above it, where the zone grows "
       "smaller. At y = 20 R passes very close without touching, and the drag has two peaks; on "
       "contact it takes the skin's 100.",
       "Both codings, since text and caption name different ones. The outline is ours: radius "
       "40, turned so that y = 20 passes two lips at different distances. y = 50 and y = 80 pass "
       "through the body.",
       fig23},
      {"fig24",
       {},
       "Drag against speed",
       "On a straight path near the cone drag grows with speed, and more so the nearer R is.",
       "0.25, 0.5 and 1 m/s on the second track of figure 22: the paper names neither.",
       fig24},
      {"fig26",
       {"fig25", "fig27"},
       "Memory on the y = 20 track, I to III",
       "Without memory drag is stepped; ten values of equal weight smooth it and come late; "
       "fading weights smooth it with less delay. Linear coding in figure 26, nonlinear in 27.",
       "Ten layers of m = 4, because the linear coding has ten values; the nonlinear one is zero "
       "from its eighth on. Memory moves on with each new voxel; the fading weights are used as "
       "printed.",
       fig26},
      {"fig28",
       {"fig29"},
       "Short memory: fine steps",
       "Three values of equal weight (IVa, IVb) turn each step into fine ones, very close to the "
       "original, like rubbing on comb teeth; the linear coding rises at a constant rate, the "
       "nonlinear one steeply near the object.",
       "As in fig26. Very close is read as less than 3 % of the peak in the mean. The rate of rise "
       "is "
       "what each layer adds: by way it depends on how the track passes the object.",
       fig28},
      {"fig30",
       {},
       "Linear against nonlinear coding",
       "With every memory the nonlinear curves lie below the linear ones; the area between them "
       "is energy saved on the traverse.",
       "As in fig26; energy is drag times way at unit surface and speed.",
       fig30},
      {"table2",
       {},
       "Performance of memories, in numbers",
       "In words: large steps without memory; smooth with ten values, the delay large, narrow "
       "features missed; moderate delay when fading; fine steps and no delay with three; gradual "
       "rise with the linear coding, steep or progressive with the nonlinear one.",
       "Step: largest change from voxel to voxel. Smoothness: total variation of the slope. "
       "Delay: how much later effective viscosity rises, in voxels and in milliseconds at 1 m/s; "
       "up to one voxel counts as none. Hidden: the most that effective viscosity is below the "
       "voxel's own. Narrow features: peaks of less than ten voxels on the tracks y = 0 to 20, "
       "missed where less than half of a peak is felt. Rising and distance are ours; a field "
       "without memory has no delay by construction, and its delay is measured against itself.",
       table2},
      {"fig34",
       {"fig33"},
       "The operator's force, absorbed at several speeds",
       "On a move along x by the cone, with nonlinear coding, drag absorbs most of the "
       "operator's force where R is nearest, and more at higher speed; what is left moves the "
       "master.",
       "Eq. 10 as M x'' + B x' + lambda (G tau1 + tau2/A)/L = Fh, tau1 = mu_e S v: even speeds "
       "of 0.05, 0.1 and 0.2 m/s, M = 2 kg and B = 1 N·s/m for a light balanced arm, all gains "
       "one, no contact. The line passes just beside the base, at z = 5; coding 32, 20, 13, 11, "
       "10, 9.",
       fig34},
  };
  return all;
}

const Item& item_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Item& item : items()) {
    if (item.name == name || std::ranges::find(item.also, name) != item.also.end()) return item;
    names.push_back(item.name);
    names.insert(names.end(), item.also.begin(), item.also.end());
  }
  std::string known;
  for (const Item& item : items()) known += (known.empty() ? "" : ", ") + item.name;
  throw Error({.where = "--only",
               .what = "the report has no such item",
               .found = "'" + name + "'",
               .expected = "one of " + known,
               .hint = nearest_word(name, names)});
}

}  // namespace vicinity::report
