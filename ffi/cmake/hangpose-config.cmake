# Targets: hangpose::hangpose for C and hangpose::cpp for C++. Both link the static archive, or the shared library if
# BUILD_SHARED_LIBS is on. hangpose::static and hangpose::shared select one explicitly.
include("${CMAKE_CURRENT_LIST_DIR}/hangpose-targets.cmake")

if(NOT TARGET hangpose::hangpose)
  add_library(hangpose::hangpose INTERFACE IMPORTED)
  if(BUILD_SHARED_LIBS)
    set_target_properties(hangpose::hangpose PROPERTIES INTERFACE_LINK_LIBRARIES hangpose::shared)
  else()
    set_target_properties(hangpose::hangpose PROPERTIES INTERFACE_LINK_LIBRARIES hangpose::static)
  endif()
  add_library(hangpose::cpp INTERFACE IMPORTED)
  set_target_properties(hangpose::cpp PROPERTIES
    INTERFACE_LINK_LIBRARIES hangpose::hangpose INTERFACE_COMPILE_FEATURES cxx_std_17)
endif()
