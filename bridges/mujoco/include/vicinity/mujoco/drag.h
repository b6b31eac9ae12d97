// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Drag of a viscosity field as passive forces of a MuJoCo model.
///
///   const vicinity::AttachedDrag drag(model, data, field);   // from here on, mj_step() feels it
///
///   each moving body: its pose and velocity, by MuJoCo
///     | tick            its body points in the field -> one wrench (teleop/tick.h)
///     | mj_applyFT      -> joint forces
///     | hold back       no more than stops the motion within one time step
///   data->qfrc_passive
///
/// Every body is felt as one rigid body, so that any joint will do, free and ball joints included,
/// and any number of them.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>
#include <vector>

#include "vicinity/drag/drag.h"
#include "vicinity/drag/moving_point.h"
#include "vicinity/drag/viscosity_memory.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/teleop/tick.h"
#include "vicinity/viscosity/field.h"

namespace vicinity {

struct MuJoCoDragOptions {
  Pose X_WM = Pose::Identity();  ///< the model's world in the workspace of the field
  /// Only these bodies, and what hangs on them; empty: all that move. What stands still feels
  /// nothing.
  std::vector<std::string> bodies = {};
  /// Links are bodies. The surface of a body is that of its geoms that can collide; where it has
  /// none of them, of all its geoms.
  BodyPointOptions points = {};
  MemoryWeights memory = {};
  DragDirection direction = DragDirection::all;
  Traversal traversal = Traversal::swept;
};

/// What a model felt.
struct MuJoCoDragOutput {
  double power = 0;  ///< taken out of the motion, >= 0 [W]
  /// 0..1: less than one where the whole drag would have stopped the motion in less than one step
  /// of the simulation, and then turned it round. A smaller time step, or more mass, gives it room.
  double scale = 1;
  Reason reason;  ///< `link` is a body of the model, `point` one of points()
};

/// Computes the drag, for whoever has a passive callback of his own. For one mjData, because its
/// points remember where they were. Under RK4 and finite differences that includes the states tried
/// on the way, unless the memory is `none` and the traversal `sampled`.
class MuJoCoDrag {
 public:
  /// Takes all memory. The model's sizes, geoms and names are read now; its joints, masses and
  /// options may change later.
  /// Errors: throws Error for a null model, bodies it does not have, a pose that is not finite, and
  /// where no body that moves has a surface.
  MuJoCoDrag(const mjModel* model, const ViscosityField& field,
             const MuJoCoDragOptions& options = {});
  ~MuJoCoDrag();
  MuJoCoDrag(const MuJoCoDrag&) = delete;
  MuJoCoDrag& operator=(const MuJoCoDrag&) = delete;

  /// Adds the drag to data->qfrc_passive. Positions and velocities must be those of data's own
  /// position and velocity stages, as they are in mjcb_passive. The clock does not matter: a state
  /// may be asked for twice, and the simulation may be set back; a body that is suddenly more than
  /// 0.1 m away starts anew where it is, and has crossed nothing on the way.
  ///
  /// @return  false, and nothing is added, for a model of another size; states that are not finite
  ///          feel nothing
  /// Real-time: as Teleoperation::tick() for each body; MuJoCo works on data's own stack.
  bool apply(const mjModel* model, mjData* data) noexcept;

  /// What the last apply() added.
  const MuJoCoDragOutput& output() const noexcept;

  /// The points that feel, in the frames of their bodies; LinkRange::link is the body.
  const BodyPoints& points() const noexcept;

 private:
  struct Bodies;
  std::unique_ptr<Bodies> bodies_;
};

/// As long as it lives, `data` feels the field: mj_step(), mj_forward() and whatever else computes
/// passive forces of it.
///
/// MuJoCo has one passive callback for the whole program, mjcb_passive. The first of these sets it,
/// the last one sets it back; one that was there before goes on being called first. Any number of
/// models and data may be attached, each to as many fields as there are. Whoever sets
/// mjcb_passive later takes it away from all of them, and calls MuJoCoDrag::apply() himself.
/// mjDSBL_PASSIVE turns it off with all other passive forces.
class AttachedDrag {
 public:
  /// @param model,data  outlive it
  /// Errors: as MuJoCoDrag, and throws Error for null data.
  AttachedDrag(const mjModel* model, mjData* data, const ViscosityField& field,
               const MuJoCoDragOptions& options = {});
  ~AttachedDrag();
  AttachedDrag(const AttachedDrag&) = delete;
  AttachedDrag& operator=(const AttachedDrag&) = delete;

  const MuJoCoDragOutput& output() const noexcept { return drag_.output(); }
  const BodyPoints& points() const noexcept { return drag_.points(); }

 private:
  static void passive(const mjModel* model, mjData* data);

  MuJoCoDrag drag_;
  const mjModel* model_;
  mjData* data_;
};

}  // namespace vicinity
