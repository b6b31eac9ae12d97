# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# The C++ that the README shows is the example that is compiled. Given: README, EXAMPLE.
file(READ ${README} readme)
file(READ ${EXAMPLE} example)
string(FIND "${readme}" "```cpp\n${example}```" position)
if(position EQUAL -1)
  message(FATAL_ERROR "${README} does not show ${EXAMPLE} word for word")
endif()
