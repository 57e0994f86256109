// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshorder::xdmf {

/// Returns an XML text without the declarations of its DOCTYPE, with each `&NAME;` replaced by the entity
/// that was declared under that name. Lines keep their numbers. Returns a text that declares no entities as
/// it is. Opens no file. Throws InputError, which names `file`, for references to external, undeclared and
/// circular entities, for parameter entities, for attributes with defaults, and for entities that add more
/// than 16 MiB. O(length of the result).
std::string with_entities_expanded(std::string text, const std::string& file);

}  // namespace meshorder::xdmf
