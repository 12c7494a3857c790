# Install rules; filled in with the CMake package.
