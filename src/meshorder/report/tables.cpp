// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/report/tables.hpp>

namespace meshorder {

std::vector<Table> tables_of(const StudyResults& /*results*/) { return {}; }
std::vector<std::string> findings_of(const StudyResults& /*results*/) { return {}; }
std::string to_markdown(const std::vector<Table>& /*tables*/) { return {}; }
std::string to_csv(const std::vector<Table>& /*tables*/) { return {}; }
std::string to_html(const Table& /*table*/) { return {}; }

}  // namespace meshorder
