// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/processor.hpp"

#include "base/text.hpp"

#include <sys/utsname.h>

#include <charconv>
#include <fstream>
#include <map>
#include <string_view>

namespace meshorder {
namespace {

/// Returns the keys and values of the first processor in Linux's /proc/cpuinfo.
std::map<std::string, std::string> facts_of_first_processor(std::istream& cpuinfo) {
  std::map<std::string, std::string> facts;
  for (std::string line; std::getline(cpuinfo, line);) {
    if (line.empty() && !facts.empty()) break;  // the next processor
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos)
      facts.emplace(trimmed(std::string_view(line).substr(0, colon)),
                    trimmed(std::string_view(line).substr(colon + 1)));
  }
  return facts;
}

}  // namespace

std::string processor_name(std::istream& cpuinfo, const std::string& architecture) {
  std::map<std::string, std::string> first_values = facts_of_first_processor(cpuinfo);
  if (!first_values["model name"].empty()) return first_values["model name"];
  std::string result = architecture + " processor";
  const std::string maker = first_values["CPU implementer"];
  const std::string part = first_values["CPU part"];
  if (!maker.empty() && !part.empty()) result += ", implementer " + maker + ", part " + part;
  return result;
}

std::string processor_of_this_machine() {
  utsname system{};
  uname(&system);
  std::ifstream cpuinfo("/proc/cpuinfo");
  return processor_name(cpuinfo, system.machine);
}

ProcessorFamily processor_family(std::istream& cpuinfo) {
  std::map<std::string, std::string> facts = facts_of_first_processor(cpuinfo);
  const auto number = [&](const char* name) {
    int value = -1;
    const std::string& text = facts[name];
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  return {facts["vendor_id"], number("cpu family"), number("model")};
}

ProcessorFamily family_of_this_machine() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  return processor_family(cpuinfo);
}

bool is_zen4(const ProcessorFamily& family) {
  return family.maker == "AuthenticAMD" && family.family == 0x19 &&
         ((family.model >= 0x10 && family.model <= 0x1f) || (family.model >= 0x60 && family.model <= 0xaf));
}

}  // namespace meshorder
