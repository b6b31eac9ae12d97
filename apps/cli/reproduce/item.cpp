// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/item.h"

#include <algorithm>

#include "reproduce/tracks.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"

namespace vicinity::report {

const std::vector<Item>& items() {
  static const std::vector<Item> all{
      {"fig5",
       {},
       "Drag against layer, for a slow and a fast point",
       "A point at constant speed meets drag that rises in steps from layer to layer; a fast one "
       "(path b) "
       "meets much more than a slow one (path a), and one that stops falls back to almost none.",
       "The circular cylinder, five layers of m = 4 as in figure 4, 0.05 and 0.2 m/s: the paper "
       "names no "
       "object and no speed.",
       fig5},
      {"fig22",
       {},
       "Six tracks by the cone",
       "R moves parallel to y in the vertical plane that touches the cone's base, at z = 1, 10, "
       "20, 30, 40 and "
       "45, with unit surface and speed and viscosities 32, 25, 20, 17, 15, 13. The higher, the "
       "less drag; "
       "track 6, level with the apex, meets no labelled voxel.",
       "A base radius of 25 voxels, since the paper gives the height only: with less than 24.5 the "
       "sixth track of an ideal "
       "cone would still meet rank 6. The plane is read as the first voxels beyond the base "
       "circle.",
       fig22},
      {"fig23",
       {},
       "The complex cylinder at y = 20, 50 and 80",
       "Six layers in sections at mid height, near the top and above it, where the zone grows "
       "smaller. At y = 20 R "
       "passes very close without touching, and the drag has two peaks; on contact it takes the "
       "skin's 100.",
       "Both codings, since text and caption name different ones. The outline is ours: radius 40, "
       "turned so that y = 20 "
       "passes two lips at different distances. y = 50 and y = 80 pass through the body.",
       fig23},
      {"fig24",
       {},
       "Drag against speed",
       "On a straight path near the cone drag grows with speed, and more so the nearer R is.",
       "0.25, 0.5 and 1 m/s on the second track of figure 22: the paper names neither.",
       fig24},
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
