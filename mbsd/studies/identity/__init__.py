"""Identity of a study: the content of build and measure, and their other inputs."""
