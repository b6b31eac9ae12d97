// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "drag_words.h"

#include <array>
#include <cctype>
#include <vector>

#include "arguments.h"

namespace vicinity::cli {

DragDirection direction_from(const std::string& word) {
  constexpr std::array directions = {std::pair{"all", DragDirection::all},
                                     std::pair{"closing", DragDirection::closing}};
  return one_of("--direction", word, directions);
}

Traversal traversal_from(const std::string& word) {
  constexpr std::array traversals = {std::pair{"swept", Traversal::swept},
                                     std::pair{"sampled", Traversal::sampled}};
  return one_of("--traversal", word, traversals);
}

ViscosityField recoded(const ViscosityField& field, const std::string& coding) {
  if (coding.empty()) return field;
  const bool is_name = std::isalpha(static_cast<unsigned char>(coding.front())) != 0;
  std::vector<Coding> codings;
  for (const FieldObject& object : field.objects()) {
    codings.push_back(
        {.mu = is_name ? named_coding(coding, object.q).mu : numbers_from("--coding", coding),
         .skin = object.coding.skin});
  }
  return field.with_codings(codings);
}

}  // namespace vicinity::cli
