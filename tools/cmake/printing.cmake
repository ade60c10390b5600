# chaintrue_print_through_gate(target): its <fmt/format.h> is grid/printing.hpp, which rejects NaN.
function(chaintrue_print_through_gate target)
  target_include_directories(${target} BEFORE PRIVATE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/grid/printing>)
endfunction()
