// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What --shot-view may ask of the page.
#pragma once

#include <string_view>

namespace vicinity::viewer {

/// The page passes over what it does not understand (page/src/app/address.ts), so that an address
/// always opens; a picture that is drawn once should be the one that was meant.
/// @param view  key=value&key=value, as in the page's address
/// Errors: throws Error for a word that the page would pass over.
void check_shot_view(std::string_view view);

}  // namespace vicinity::viewer
