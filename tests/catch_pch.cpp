// Gives the precompiled header, which the test programs reuse, a source to be built for.
