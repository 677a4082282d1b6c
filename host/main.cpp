// stokes: spectral rendering of fluorescence on translucent materials.
int main() { return 0; }
