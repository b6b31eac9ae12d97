// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Joint states, and what was felt with them, out of an MCAP recording: anybody's, or ours.
#pragma once

#include <filesystem>

#include "replay/log_text.h"

namespace vicinity::cli {

/// One line for each joint state: t, the joints' names, qd_<joint>... where they are in all of
/// them; t is the message's stamp, or, where stamps are zero, when it was recorded. From our own
/// recordings also tau_<joint>..., tool_fx,tool_fy,tool_fz,tool_mx,tool_my,tool_mz (in the axes of
/// the tool link), master_force, status, reason_link, reason_object, reason_rank,
/// reason_distance_mm. Numbers lose nothing on the way through text.
///
/// Of several topics with joint states it takes /joint_states. Of senders that share that topic,
/// an arm and its gripper say, it takes those messages that name the most joints. Lines are sorted
/// by time; of messages with one time the first counts.
///
/// Errors: throws Error for a file that is no recording or is damaged, joint states that cannot be
/// decoded, none, or several topics with none of them /joint_states. A recording that was cut off
/// is read up to there, and said so.
LogText mcap_as_csv(const std::filesystem::path& path);

}  // namespace vicinity::cli
