# chaintrue_print_through_gate(target): its <fmt/format.h> is the one that lets no NaN through, grid/printing.hpp.
function(chaintrue_print_through_gate target)
  target_include_directories(${target} BEFORE PRIVATE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/grid/printing>)
endfunction()
