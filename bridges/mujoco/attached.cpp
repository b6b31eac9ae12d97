// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// MuJoCo's passive callback knows no user: which data feels which field is written down here.

#include <algorithm>
#include <mutex>
#include <shared_mutex>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/mujoco/drag.h"

namespace vicinity {
namespace {

struct Attached {
  const mjModel* model;
  mjData* data;
  MuJoCoDrag* drag;
};

// Simulations on several threads read it, each for its own data; it is written when one is
// attached.
struct Register {
  std::shared_mutex mutex;
  std::vector<Attached> entries;
  mjfGeneric before = nullptr;  // the callback that was there
};

Register& all() {
  static Register only;
  return only;
}

mjData* checked(mjData* data) {
  if (data == nullptr) throw Error({.where = "drag in MuJoCo", .what = "there is no data"});
  return data;
}

}  // namespace

AttachedDrag::AttachedDrag(const mjModel* model, mjData* data, const ViscosityField& field,
                           const MuJoCoDragOptions& options)
    : drag_(model, field, options), model_(model), data_(checked(data)) {
  const std::unique_lock lock(all().mutex);
  all().entries.push_back({model_, data_, &drag_});
  if (all().entries.size() == 1) all().before = std::exchange(mjcb_passive, &passive);
}

AttachedDrag::~AttachedDrag() {
  const std::unique_lock lock(all().mutex);
  std::erase_if(all().entries, [this](const Attached& each) { return each.drag == &drag_; });
  if (all().entries.empty() && mjcb_passive == &passive) mjcb_passive = all().before;
}

void AttachedDrag::passive(const mjModel* model, mjData* data) {
  const std::shared_lock lock(all().mutex);
  if (all().before != nullptr) all().before(model, data);
  for (const Attached& each : all().entries) {
    if (each.model == model && each.data == data) each.drag->apply(model, data);
  }
}

}  // namespace vicinity
