# Writes sheaf.spdx.json, what this build is made of: SPDX 2.3, with the versions that CMake and pkg-config have found. The time
# is that of SOURCE_DATE_EPOCH where it is set, so that a build can be repeated to the bit.
function(sheaf_version_of variable)
  foreach(candidate IN LISTS ARGN)
    if(${candidate})
      set(${variable} ${${candidate}} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(${variable} NOASSERTION PARENT_SCOPE)
endfunction()

# Name, licence, and the variables that may hold its version.
set(SHEAF_PARTS
  "highway|Apache-2.0|hwy_VERSION" "oneTBB|Apache-2.0|TBB_VERSION" "fmt|MIT|fmt_VERSION" "libpng|libpng-2.0|PNG_VERSION_STRING"
  "tinygltf|MIT|TinyGLTF_VERSION" "libjpeg-turbo|BSD-3-Clause AND IJG AND Zlib|TURBOJPEG_VERSION" "nlohmann-json|MIT|nlohmann_json_VERSION"
  "glm|MIT|glm_VERSION")
if(SHEAF_BUILD_COMMAND)
  list(APPEND SHEAF_PARTS "CLI11|BSD-3-Clause|CLI11_VERSION")
endif()
if(OpenEXR_FOUND)
  list(APPEND SHEAF_PARTS "OpenEXR|BSD-3-Clause|OpenEXR_VERSION")
endif()
if(OPENIMAGEIO_FOUND)
  list(APPEND SHEAF_PARTS "OpenImageIO|BSD-3-Clause|OPENIMAGEIO_VERSION")
endif()
if(TARGET sheaf_python)
  list(APPEND SHEAF_PARTS "pybind11|BSD-3-Clause|pybind11_VERSION")
endif()

string(TIMESTAMP SHEAF_SPDX_TIME "%Y-%m-%dT%H:%M:%SZ" UTC)
set(SHEAF_SPDX_PACKAGES "")
set(SHEAF_SPDX_RELATIONS "")
foreach(part IN LISTS SHEAF_PARTS)
  string(REPLACE "|" ";" part "${part}")
  list(GET part 0 name)
  list(GET part 1 licence)
  list(GET part 2 variable)
  sheaf_version_of(version ${variable})
  string(APPEND SHEAF_SPDX_PACKAGES ",
    {\"SPDXID\": \"SPDXRef-${name}\", \"name\": \"${name}\", \"versionInfo\": \"${version}\", \"downloadLocation\": \"NOASSERTION\",
     \"filesAnalyzed\": false, \"licenseConcluded\": \"${licence}\", \"licenseDeclared\": \"${licence}\", \"copyrightText\": \"NOASSERTION\"}")
  string(APPEND SHEAF_SPDX_RELATIONS ",
    {\"spdxElementId\": \"SPDXRef-sheaf\", \"relationshipType\": \"DEPENDS_ON\", \"relatedSpdxElement\": \"SPDXRef-${name}\"}")
endforeach()
configure_file(${CMAKE_CURRENT_SOURCE_DIR}/src/core/sheaf.spdx.json.in ${CMAKE_CURRENT_BINARY_DIR}/sheaf.spdx.json @ONLY)
