// JSON as the command prints it.
#ifndef SHEAF_APP_JSON_TEXT_H_
#define SHEAF_APP_JSON_TEXT_H_

#include <nlohmann/json.hpp>
#include <string>

namespace sheaf {

// Indented by two, with a newline at the end; bytes that are no UTF-8 are replaced.
inline std::string JsonText(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace sheaf

#endif  // SHEAF_APP_JSON_TEXT_H_
