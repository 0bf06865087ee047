# The warnings that every target of ours compiles with, and none of its users.
function(lbm_enable_warnings target)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
endfunction()
