# SPDX-License-Identifier: MIT
# Sanitizers, for everything that is compiled. The model flags become global too: a sanitizer keeps functions that are
# inlined elsewhere, so all files must agree on the instruction set.

set(MYRIAD_TEST_LAUNCHER)
set(MYRIAD_TEST_ENVIRONMENT)
if(MYRIAD_SANITIZE)
    add_compile_definitions(MYRIAD_SCALAR_LANES)
    add_compile_options("-fsanitize=${MYRIAD_SANITIZE}" -fno-sanitize-recover=all -fno-omit-frame-pointer)
    add_link_options("-fsanitize=${MYRIAD_SANITIZE}")
    if(MYRIAD_SANITIZE MATCHES "address")
        # Marking the scope of every inlined temporary keeps packs in memory and more than doubles the compile time.
        add_compile_options(-fno-sanitize-address-use-after-scope)
    endif()
    myriad_model_flags(flags)
    add_compile_options(${flags})

    if(MYRIAD_SANITIZE MATCHES "thread")
        if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
            message(FATAL_ERROR
                    "MYRIAD_SANITIZE=thread needs clang++ (Debian packages clang and libomp-dev): the OpenMP "
                                "runtime of g++ does not tell the sanitizer of its barriers, so that every parallel "
                                "region would be reported")
        endif()
        # The OpenMP runtime is not instrumented. libarcher, which it loads by itself, informs the sanitizer of its
        # locks and barriers; its own accesses must be ignored, or every parallel region is reported.
        set(MYRIAD_TEST_ENVIRONMENT "TSAN_OPTIONS=ignore_noninstrumented_modules=1")

        # Some kernels place memory where the sanitizer of clang 14 to 17 cannot; without randomisation they do not.
        find_program(MYRIAD_SETARCH setarch)
        mark_as_advanced(MYRIAD_SETARCH)
        if(MYRIAD_SETARCH)
            execute_process(COMMAND "${MYRIAD_SETARCH}" -R true RESULT_VARIABLE refused OUTPUT_QUIET ERROR_QUIET)
            if(refused EQUAL 0)
                set(MYRIAD_TEST_LAUNCHER "${MYRIAD_SETARCH}" -R)
            endif()
        endif()
    endif()
endif()
