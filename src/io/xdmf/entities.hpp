// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder::xdmf {

/// Returns an XML text with the entities that its DOCTYPE declares put in place of `&NAME;`, and without the
/// declarations; its lines keep their numbers. A text that declares none is returned as it is. Opens no
/// file. Throws InputError, which names `file`, for references to external, undeclared and circular entities,
/// for parameter entities, for attributes with defaults, and for entities that add more than 16 MiB. O(length
/// of the result).
std::string with_entities_expanded(std::string text, const std::string& file);

}  // namespace meshorder::xdmf
