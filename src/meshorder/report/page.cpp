// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/report/page.hpp>

namespace meshorder {

std::string to_html(const Page& /*page*/) { return {}; }
void write_page(const Page& /*page*/, const std::filesystem::path& /*path*/) {}

}  // namespace meshorder
