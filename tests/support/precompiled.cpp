// Nothing but the owner of a precompiled header: see tests/CMakeLists.txt.
